// The containers of glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021, sections 3.6 and 4.4).
#include "scene/gltf_file.h"

#include "core/fail.h"
#include "core/file.h"

#include <pellucid/error.h>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace pellucid {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 15> kSupportedExtensions = {
    "KHR_materials_transmission", "KHR_materials_volume",
    "KHR_materials_ior",          "KHR_materials_dispersion",
    "KHR_materials_unlit",        "KHR_materials_emissive_strength",
    "KHR_texture_transform",      "KHR_mesh_quantization",
    "KHR_lights_punctual",        "KHR_materials_diffuse_transmission",
    "KHR_materials_clearcoat",    "KHR_materials_sheen",
    "KHR_materials_specular",     "KHR_materials_iridescence",
    "KHR_materials_anisotropy"};

std::string_view text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::uint32_t u32_at(std::span<const std::byte> bytes, std::size_t offset) {
    std::uint32_t value = 0;  // little-endian, as are all machines that Vulkan runs on
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

/// Splits the file into its JSON text and the binary chunk, which only .glb files have.
void split_container(const std::filesystem::path& path, std::span<const std::byte> file, std::string_view& text,
                     std::span<const std::byte>& binary) {
    constexpr std::uint32_t kJson = 0x4e4f534a, kBin = 0x004e4942;
    if (file.empty()) fail(path, "is empty");
    text = text_of(file);
    if (!text.starts_with("glTF")) return;
    text = {};
    if (file.size() < 20) fail(path, "GLB header is incomplete");
    if (u32_at(file, 4) != 2) fail(path, fmt::format("GLB version {} is not supported", u32_at(file, 4)));
    const std::size_t length = u32_at(file, 8);
    if (length > file.size() || length < 20)
        fail(path, fmt::format("GLB header announces {} bytes, the file has {} (truncated?)", length, file.size()));
    for (std::size_t at = 12; at + 8 <= length;) {
        const std::size_t size = u32_at(file, at);
        const std::uint32_t type = u32_at(file, at + 4);
        if (size > length - at - 8) fail(path, "GLB chunk is longer than the file");
        const auto chunk = file.subspan(at + 8, size);
        if (at == 12 && type != kJson) fail(path, "GLB file does not begin with its JSON chunk");
        if (at == 12) text = text_of(chunk);
        if (at != 12 && type == kBin && binary.empty()) binary = chunk;
        at += 8 + (size + 3) / 4 * 4;
    }
}

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

json parse_json(const std::filesystem::path& path, std::string_view text) {
    check_depth(path, text);
    json root = json::parse(text.begin(), text.end());
    if (!root.is_object()) fail(path, "JSON is not an object");
    return root;
}

void check_version(const std::filesystem::path& path, const json& root) {
    const auto asset = root.find("asset");
    if (asset == root.end() || !asset->is_object() || !asset->contains("version") || !(*asset)["version"].is_string())
        fail(path, "is no glTF file: asset.version is missing");
    const std::string version = (*asset)["version"];
    if (!version.starts_with("2.")) fail(path, fmt::format("glTF version {} is not supported, only 2", version));
}

bool supported(const json& extension) {
    return extension.is_string() && std::find(kSupportedExtensions.begin(), kSupportedExtensions.end(),
                                              extension.get<std::string>()) != kSupportedExtensions.end();
}

void check_extensions(const std::filesystem::path& path, const json& root, Warnings& warnings) {
    for (const json& extension : root.value("extensionsRequired", json::array()))
        if (!supported(extension))
            fail(path, fmt::format("requires glTF extension {}, which is not supported",
                                   extension.is_string() ? extension.get<std::string>() : extension.dump()));
    for (const json& extension : root.value("extensionsUsed", json::array()))
        if (!supported(extension))
            warnings.add(fmt::format("{}: glTF extension {} is ignored", path.filename().string(),
                                     extension.is_string() ? extension.get<std::string>() : extension.dump()));
}

/// "%20" and the like as the characters that they stand for.
std::string percent_decoded(const std::string& uri) {
    const auto digit = [](char c) {
        if (c >= '0' && c <= '9') return c - '0';
        if (c >= 'a' && c <= 'f') return c - 'a' + 10;
        if (c >= 'A' && c <= 'F') return c - 'A' + 10;
        return -1;
    };
    std::string decoded;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0) {
            decoded += static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2]));
            i += 2;
        } else {
            decoded += uri[i];
        }
    }
    return decoded;
}

/// Content of a data URI, or of a file beside the glTF file. Throws Error.
std::vector<std::byte> read_uri(const std::filesystem::path& path, const std::string& uri) {
    if (!tinygltf::IsDataURI(uri)) {
        if (uri.starts_with("data:")) throw Error("data URI of unknown kind: " + uri.substr(0, uri.find(',')));
        return read_file(path.parent_path() / percent_decoded(uri));
    }
    std::vector<unsigned char> bytes;
    std::string mime_type;
    if (!tinygltf::DecodeDataURI(&bytes, mime_type, uri, 0, false)) throw Error("damaged data URI");
    std::vector<std::byte> content(bytes.size());
    if (!bytes.empty()) std::memcpy(content.data(), bytes.data(), bytes.size());
    return content;
}

void read_buffers(GltfFile& gltf, const json& root, std::span<const std::byte> binary) {
    const json buffers = root.value("buffers", json::array());
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        const std::size_t length = buffers[i].at("byteLength").get<std::size_t>();
        const std::string uri = buffers[i].value("uri", std::string());
        std::vector<std::byte> bytes;
        if (!uri.empty()) {
            try {
                bytes = read_uri(gltf.path, uri);
            } catch (const Error& error) {
                fail(gltf.path, fmt::format("buffer {}: {}", i, error.what()));
            }
        } else if (i == 0) {
            bytes.assign(binary.begin(), binary.end());
        }
        if (bytes.size() < length)
            fail(gltf.path,
                 fmt::format("buffer {}{} has {} bytes, {} are needed", i,
                             uri.empty() || uri.starts_with("data:") ? "" : " (" + uri + ")", bytes.size(), length));
        bytes.resize(length);
        gltf.buffers.push_back(std::move(bytes));
    }
}

/// Images are of use only to the eye: whatever is wrong with one is a warning.
void read_images(GltfFile& gltf, const json& root) {
    const json images = root.value("images", json::array());
    for (std::size_t i = 0; i < images.size(); ++i) {
        GltfImage image;
        image.name = fmt::format("image {}", i);
        try {
            const std::string uri = images[i].value("uri", std::string());
            const std::string name = images[i].value("name", std::string());
            if (!uri.empty() && !uri.starts_with("data:")) {
                image.name = percent_decoded(uri);
            } else if (!name.empty()) {
                image.name = name;
            }
            if (!uri.empty()) {
                image.bytes = read_uri(gltf.path, uri);
            } else {
                const auto bytes = gltf.view(images[i].at("bufferView").get<int>(), image.name);
                image.bytes.assign(bytes.begin(), bytes.end());
            }
        } catch (const Error& error) {
            image.problem = error.what();
        } catch (const json::exception&) {
            image.problem = image.name + " names neither a file nor a buffer view";
        }
        gltf.images.push_back(std::move(image));
    }
}

void parse_model(GltfFile& gltf, json root, Warnings& warnings) {
    root.erase("buffers");
    root.erase("images");
    // Skins need not have inverse bind matrices, but tinygltf complains.
    if (const auto skins = root.find("skins"); skins != root.end() && skins->is_array())
        for (json& skin : *skins)
            if (skin.is_object() && !skin.contains("inverseBindMatrices")) skin["inverseBindMatrices"] = -1;
    const std::string text = root.dump(-1, ' ', false, json::error_handler_t::replace);
    std::string problem, remark;
    tinygltf::TinyGLTF parser;
    if (!parser.LoadASCIIFromString(&gltf.model, &problem, &remark, text.data(), static_cast<unsigned>(text.size()),
                                    ""))
        fail(gltf.path, problem.empty() ? "malformed glTF" : problem);
    if (!problem.empty() || !remark.empty())
        warnings.add(fmt::format("{}: {} {}", gltf.path.filename().string(), problem, remark));
}

}  // namespace

std::span<const std::byte> GltfFile::view(int buffer_view, const std::string& user) const {
    if (buffer_view < 0 || std::size_t(buffer_view) >= model.bufferViews.size())
        fail(path, fmt::format("{}: there is no buffer view {}", user, buffer_view));
    const tinygltf::BufferView& v = model.bufferViews[std::size_t(buffer_view)];
    if (v.buffer < 0 || std::size_t(v.buffer) >= buffers.size())
        fail(path, fmt::format("{}: buffer view {}: there is no buffer {}", user, buffer_view, v.buffer));
    const std::vector<std::byte>& buffer = buffers[std::size_t(v.buffer)];
    if (v.byteOffset > buffer.size() || v.byteLength > buffer.size() - v.byteOffset)
        fail(path, fmt::format("{}: buffer view {} reaches beyond its buffer", user, buffer_view));
    return std::span(buffer).subspan(v.byteOffset, v.byteLength);
}

GltfFile read_gltf_file(const std::filesystem::path& path, Warnings& warnings) {
    const std::vector<std::byte> file = read_file(path);
    std::string_view text;
    std::span<const std::byte> binary;
    split_container(path, file, text, binary);
    GltfFile gltf;
    gltf.path = path;
    try {
        const json root = parse_json(path, text);
        check_version(path, root);
        check_extensions(path, root, warnings);
        parse_model(gltf, root, warnings);
        read_buffers(gltf, root, binary);
        read_images(gltf, root);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& cause) {
        // Values of an unexpected JSON type, here or in tinygltf.
        fail(path, std::string("malformed glTF: ") + cause.what());
    }
    return gltf;
}

}  // namespace pellucid
