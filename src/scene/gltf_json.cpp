// The JSON of glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021), and what tinygltf refuses in valid files.
#include "scene/gltf_json.h"

#include "core/fail.h"

#include <pellucid/gltf_extensions.h>

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace pellucid {
namespace {

using nlohmann::json;

/// tinygltf recurses into extensions and extras, so their depth must not reach the stack's.
void check_depth(const std::filesystem::path& path, std::string_view text) {
    constexpr int kMaxDepth = 100;
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"') in_string = !in_string;
        if (in_string && c == '\\') ++i;
        if (in_string) continue;
        if ((c == '{' || c == '[') && ++depth > kMaxDepth) fail(path, "JSON is nested too deeply");
        if (c == '}' || c == ']') --depth;
    }
}

void check_version(const std::filesystem::path& path, const json& root) {
    const auto asset = root.find("asset");
    if (asset == root.end() || !asset->is_object() || !asset->contains("version") || !(*asset)["version"].is_string())
        fail(path, "is no glTF file: asset.version is missing");
    const std::string version = (*asset)["version"];
    if (!version.starts_with("2."))
        fail(path, fmt::format("glTF version {} is not supported, only 2: export the file as glTF 2.0", version));
}

std::string name_of(const json& extension) {
    return extension.is_string() ? extension.get<std::string>() : extension.dump();
}

GltfExtension known_extension(const std::string& name) {
    for (const GltfExtension& extension : gltf_extensions())
        if (extension.name == name) return extension;
    return {.name = {}, .support = GltfSupport::kRefused, .how = {}};
}

void check_extensions(const std::filesystem::path& path, const json& root, Warnings& warnings) {
    for (const json& required : root.value("extensionsRequired", json::array())) {
        const GltfExtension extension = known_extension(name_of(required));
        if (extension.support == GltfSupport::kRefused)
            fail(path, fmt::format("requires glTF extension {}, which is not supported{}{}: export the file without it",
                                   name_of(required), extension.how.empty() ? "" : ", ", extension.how));
    }
    for (const char* const list : {"extensionsUsed", "extensionsRequired"}) {
        for (const json& used : root.value(list, json::array())) {
            const GltfExtension extension = known_extension(name_of(used));
            if (extension.support < GltfSupport::kIgnored) continue;
            warnings.add(fmt::format("{}: glTF extension {} is ignored{}{}", path.filename().string(), name_of(used),
                                     extension.how.empty() ? "" : ": ", extension.how));
        }
    }
}

/// Writes 3.0 as 3: tinygltf takes no counts and indices with a point, JSON does.
void write_whole_numbers(json& value) {
    constexpr double kMost = 2147483647.0;  // numbers of extensions have 32 bits there
    if (value.is_structured()) {
        for (json& element : value) write_whole_numbers(element);
    } else if (value.is_number_float()) {
        const double number = value;
        if (std::abs(number) <= kMost && number == std::floor(number) && !(number == 0.0 && std::signbit(number)))
            value = static_cast<std::int64_t>(number);
    }
}

/// Where an accessor of a primitive's indices stands.
struct Indices {
    std::size_t mesh, primitive;
    int accessor;
};

bool has_view(const json& root, const json& accessor) {
    const auto accessors = root.find("accessors");
    if (accessors == root.end() || !accessors->is_array() || !accessor.is_number_integer()) return true;
    const auto index = accessor.get<std::int64_t>();
    if (index < 0 || std::size_t(index) >= accessors->size()) return true;
    const json& found = (*accessors)[std::size_t(index)];
    return !found.is_object() || found.contains("bufferView");
}

/// tinygltf wants a buffer view behind all indices. Compressed ones have none.
std::vector<Indices> take_indices_without_view(json& root) {
    std::vector<Indices> taken;
    const auto meshes = root.find("meshes");
    if (meshes == root.end() || !meshes->is_array()) return taken;
    for (std::size_t m = 0; m < meshes->size(); ++m) {
        json& mesh = (*meshes)[m];
        if (!mesh.is_object() || !mesh.contains("primitives") || !mesh["primitives"].is_array()) continue;
        for (std::size_t p = 0; p < mesh["primitives"].size(); ++p) {
            json& primitive = mesh["primitives"][p];
            if (!primitive.is_object() || !primitive.contains("indices") || has_view(root, primitive["indices"]))
                continue;
            taken.push_back({m, p, primitive["indices"].get<int>()});
            primitive.erase("indices");
        }
    }
    return taken;
}

/// "/nodes/3/translation" of KHR_animation_pointer as node and path. Returns whether it names such a property.
bool follow_pointer(json& target) {
    const json pointer = target.value(json::json_pointer("/extensions/KHR_animation_pointer/pointer"), json());
    if (!pointer.is_string()) return false;
    const std::string text = pointer;
    constexpr std::string_view kNodes = "/nodes/";
    if (!text.starts_with(kNodes)) return false;
    const std::size_t slash = text.find('/', kNodes.size());
    if (slash == text.npos || slash == kNodes.size() || slash > kNodes.size() + 9) return false;
    const std::string number = text.substr(kNodes.size(), slash - kNodes.size());
    if (number.find_first_not_of("0123456789") != number.npos) return false;
    const std::string path = text.substr(slash + 1);
    if (path != "translation" && path != "rotation" && path != "scale" && path != "weights") return false;
    target["node"] = std::stoi(number);
    target["path"] = path;
    return true;
}

/// tinygltf wants a node in every channel; those of pointers, or of what an extension animates, have none.
void keep_channels_of_nodes(json& root, const std::filesystem::path& path, Warnings& warnings) {
    const auto animations = root.find("animations");
    if (animations == root.end() || !animations->is_array()) return;
    std::size_t left_out = 0;
    for (json& animation : *animations) {
        if (!animation.is_object() || !animation.contains("channels") || !animation["channels"].is_array()) continue;
        json kept = json::array();
        for (json& channel : animation["channels"]) {
            const bool has_target = channel.is_object() && channel.contains("target") && channel["target"].is_object();
            if (has_target && channel["target"].value("path", json()) == "pointer" &&
                !follow_pointer(channel["target"])) {
                ++left_out;
            } else if (!has_target || channel["target"].contains("node")) {
                kept.push_back(std::move(channel));
            }
        }
        animation["channels"] = std::move(kept);
    }
    if (left_out > 0)
        warnings.add(
            fmt::format("{}: {} animation channel{} of materials, lights or cameras left out, their values at "
                        "rest are drawn",
                        path.filename().string(), left_out, left_out == 1 ? "" : "s"));
}

}  // namespace

json parse_gltf_json(const std::filesystem::path& path, std::string_view text, Warnings& warnings) {
    check_depth(path, text);
    json root = json::parse(text.begin(), text.end());
    if (!root.is_object()) fail(path, "JSON is not an object");
    check_version(path, root);
    check_extensions(path, root, warnings);
    return root;
}

tinygltf::Model gltf_model(const std::filesystem::path& path, json root, Warnings& warnings) {
    root.erase("buffers");
    root.erase("images");
    write_whole_numbers(root);
    // Skins need not have inverse bind matrices, but tinygltf complains.
    if (const auto skins = root.find("skins"); skins != root.end() && skins->is_array())
        for (json& skin : *skins)
            if (skin.is_object() && !skin.contains("inverseBindMatrices")) skin["inverseBindMatrices"] = -1;
    keep_channels_of_nodes(root, path, warnings);
    const std::vector<Indices> taken = take_indices_without_view(root);
    const std::string text = root.dump(-1, ' ', false, json::error_handler_t::replace);
    std::string problem, remark;
    tinygltf::TinyGLTF parser;
    tinygltf::Model model;
    if (!parser.LoadASCIIFromString(&model, &problem, &remark, text.data(), static_cast<unsigned>(text.size()), ""))
        fail(path, "malformed glTF: " + (problem.empty() ? "unknown cause" : problem));
    if (!problem.empty() || !remark.empty())
        warnings.add(fmt::format("{}: {} {}", path.filename().string(), problem, remark));
    for (const Indices& indices : taken) {
        auto& primitives = model.meshes.at(indices.mesh).primitives;
        if (indices.primitive < primitives.size()) primitives[indices.primitive].indices = indices.accessor;
    }
    return model;
}

}  // namespace pellucid
