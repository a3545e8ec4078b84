// Binary glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021, section 4.4).
#include "core/fail.h"
#include "core/file.h"
#include "scene/write/gltf_materials_json.h"
#include "scene/write/png_bytes.h"
#include "scene/write/scene_writers.h"

#include <pellucid/file.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <utility>

namespace pellucid {
namespace {

using nlohmann::json;

json matrix_json(const glm::mat4& m) {
    json numbers = json::array();
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) numbers.push_back(m[c][r]);
    return numbers;
}

/// Transform whose -Z is `direction`.
glm::mat4 looking_along(const glm::vec3& position, const glm::vec3& direction) {
    const glm::vec3 z = -direction;
    const glm::vec3 aside = std::abs(z.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 x = glm::normalize(glm::cross(aside, z));
    return {glm::vec4(x, 0), glm::vec4(glm::cross(z, x), 0), glm::vec4(z, 0), glm::vec4(position, 1)};
}

class GlbWriter {
public:
    GlbWriter(const std::filesystem::path& file, const Scene& scene, std::vector<std::string>& left_out)
        : file_(file), scene_(scene), left_out_(left_out) {}

    void write() {
        root_["asset"] = {{"version", "2.0"}, {"generator", "Pellucid"}};
        root_["scene"] = 0;
        add_images();
        GltfMaterialsJson materials = gltf_materials_json(scene_, left_out_);
        if (!materials.samplers.empty()) root_["samplers"] = std::move(materials.samplers);
        if (!materials.textures.empty()) root_["textures"] = std::move(materials.textures);
        root_["materials"] = std::move(materials.materials);
        add_objects();
        for (const Camera& camera : scene_.cameras) add_camera(camera);
        for (const Light& light : scene_.lights) add_light(light);
        add_scene();
        name_extensions(root_);
        if (!extensions_.empty()) root_["extensionsUsed"] = extensions_;
        write_file();
    }

private:
    std::size_t add_view(std::span<const std::byte> bytes) {
        bytes_.resize((bytes_.size() + 3) / 4 * 4);
        root_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}});
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
        return root_["bufferViews"].size() - 1;
    }

    template <class T>
    std::size_t add_accessor(const std::vector<T>& values, const char* type, int component, std::size_t count) {
        const std::size_t view = add_view(std::as_bytes(std::span(values)));
        root_["accessors"].push_back(
            {{"bufferView", view}, {"componentType", component}, {"type", type}, {"count", count}});
        return root_["accessors"].size() - 1;
    }

    void add_images() {
        for (std::size_t i = 0; i < scene_.images.size(); ++i) {
            if (!is_exact_as_png(scene_.images[i]))
                left_out_.push_back(
                    fmt::format("image {}: rounded to 8 bits, and clipped to 0..1", scene_.image_names[i]));
            const std::size_t view = add_view(png_bytes(scene_.images[i]));
            root_["images"].push_back(
                {{"bufferView", view}, {"mimeType", "image/png"}, {"name", scene_.image_names[i]}});
        }
    }

    /// Objects of one body become primitives of one mesh, which is how files say that they bound one solid.
    void add_objects() {
        std::set<int> bodies;
        for (std::size_t i = 0; i < scene_.objects.size(); ++i) {
            const Object& object = scene_.objects[i];
            std::vector<const Object*> parts{&object};
            if (object.body >= 0) {
                if (!bodies.insert(object.body).second) continue;
                for (std::size_t j = i + 1; j < scene_.objects.size(); ++j)
                    if (scene_.objects[j].body == object.body) parts.push_back(&scene_.objects[j]);
            }
            json node{{"name", object.name}, {"mesh", mesh_of(parts)}};
            if (object.world_from_object != glm::mat4(1.0f)) node["matrix"] = matrix_json(object.world_from_object);
            if (object.priority != 0) node["extras"]["pellucid"]["priority"] = object.priority;
            root_["nodes"].push_back(std::move(node));
        }
    }

    std::size_t mesh_of(const std::vector<const Object*>& parts) {
        std::vector<std::pair<int, int>> key;
        for (const Object* part : parts) key.emplace_back(part->mesh, part->material);
        const auto [found, is_new] = meshes_.try_emplace(key, meshes_.size());
        if (!is_new) return found->second;
        json primitives = json::array();
        for (const auto& [mesh, material] : key)
            primitives.push_back(
                {{"attributes", attributes_of(mesh)}, {"indices", indices_[mesh]}, {"material", material}});
        root_["meshes"].push_back(
            {{"name", scene_.meshes[std::size_t(parts.front()->mesh)].name}, {"primitives", primitives}});
        return found->second;
    }

    const json& attributes_of(int index) {
        const auto [found, is_new] = attributes_.try_emplace(index);
        if (!is_new) return found->second;
        constexpr int kFloat = 5126, kUnsigned = 5125;
        const Mesh& mesh = scene_.meshes[std::size_t(index)];
        json& attributes = found->second;
        const std::size_t count = mesh.positions.size();
        attributes["POSITION"] = add_accessor(mesh.positions, "VEC3", kFloat, count);
        glm::vec3 low = mesh.positions.front(), high = low;
        for (const glm::vec3& p : mesh.positions) low = glm::min(low, p), high = glm::max(high, p);
        json& accessor = root_["accessors"].back();
        accessor["min"] = {low.x, low.y, low.z};
        accessor["max"] = {high.x, high.y, high.z};
        attributes["NORMAL"] = add_accessor(mesh.normals, "VEC3", kFloat, count);
        for (int set = 0; set < 2; ++set)
            if (!mesh.texcoords[set].empty())
                attributes[fmt::format("TEXCOORD_{}", set)] = add_accessor(mesh.texcoords[set], "VEC2", kFloat, count);
        if (!mesh.colors.empty()) attributes["COLOR_0"] = add_accessor(mesh.colors, "VEC4", kFloat, count);
        if (!mesh.tangents.empty()) attributes["TANGENT"] = add_accessor(mesh.tangents, "VEC4", kFloat, count);
        indices_[index] = add_accessor(mesh.triangles, "SCALAR", kUnsigned, 3 * mesh.triangles.size());
        return attributes;
    }

    void add_camera(const Camera& camera) {
        // Files must have a near plane, where the scene's own is chosen from its bounds.
        const float near_plane = camera.near_plane > 0.0f ? camera.near_plane : 1e-3f * scene_bounds(scene_).radius;
        json planes{{"znear", near_plane}};
        if (camera.far_plane > near_plane) planes["zfar"] = camera.far_plane;
        json to{{"name", camera.name}, {"type", camera.orthographic ? "orthographic" : "perspective"}};
        if (camera.orthographic) {
            if (!planes.contains("zfar")) planes["zfar"] = near_plane + 1e4f * scene_bounds(scene_).radius;
            planes["xmag"] = planes["ymag"] = 0.5f * camera.vertical_extent;
            to["orthographic"] = planes;
        } else {
            planes["yfov"] = camera.vertical_fov;
            to["perspective"] = planes;
        }
        root_["cameras"].push_back(std::move(to));
        root_["nodes"].push_back({{"name", camera.name},
                                  {"camera", root_["cameras"].size() - 1},
                                  {"matrix", matrix_json(camera.world_from_view)}});
    }

    void add_light(const Light& light) {
        const float intensity = std::max({light.intensity.r, light.intensity.g, light.intensity.b});
        const glm::vec3 color = intensity > 0.0f ? light.intensity / intensity : glm::vec3(1.0f);
        const bool sun = light.kind == Light::Kind::kDirectional;
        json to{{"name", light.name}, {"intensity", intensity}, {"color", {color.r, color.g, color.b}}};
        to["type"] = sun ? "directional" : light.kind == Light::Kind::kPoint ? "point" : "spot";
        to["extras"] = sun ? json{{"angular_diameter", light.angular_diameter}} : json{{"radius", light.radius}};
        if (!sun && std::isfinite(light.range)) to["range"] = light.range;
        if (light.kind == Light::Kind::kSpot)
            to["spot"] = {{"innerConeAngle", light.inner_cone_angle}, {"outerConeAngle", light.outer_cone_angle}};
        json& lights = root_["extensions"]["KHR_lights_punctual"]["lights"];
        lights.push_back(std::move(to));
        json node{{"name", light.name}, {"matrix", matrix_json(looking_along(light.position, light.direction))}};
        node["extensions"]["KHR_lights_punctual"]["light"] = lights.size() - 1;
        root_["nodes"].push_back(std::move(node));
    }

    /// Nodes are in the scene's frame, whose origin in the file's world has more digits than they.
    void add_scene() {
        json all = json::array();
        for (std::size_t i = 0; i < root_["nodes"].size(); ++i) all.push_back(i);
        if (scene_.origin != glm::dvec3(0.0)) {
            root_["nodes"].push_back({{"name", "origin"},
                                      {"translation", {scene_.origin.x, scene_.origin.y, scene_.origin.z}},
                                      {"children", all}});
            all = {root_["nodes"].size() - 1};
        }
        root_["scenes"].push_back({{"nodes", all}});
    }

    void name_extensions(const json& value) {
        if (value.is_object() && value.contains("extensions"))
            for (const auto& [name, properties] : value["extensions"].items()) extensions_.insert(name);
        if (value.is_structured())
            for (const auto& each : value) name_extensions(each);
    }

    void write_file() {
        bytes_.resize((bytes_.size() + 3) / 4 * 4);
        root_["buffers"].push_back({{"byteLength", bytes_.size()}});
        std::string text = root_.dump(-1, ' ', false, json::error_handler_t::replace);
        text.resize((text.size() + 3) / 4 * 4, ' ');
        const std::size_t size = 12 + 8 + text.size() + 8 + bytes_.size();
        if (size > std::numeric_limits<std::uint32_t>::max())
            fail(file_, "cannot write: a .glb file has at most 4 GiB");
        std::string content;
        content.reserve(size);
        const auto word = [&content](std::size_t value) {
            const auto number = std::uint32_t(value);
            char little_endian[4];
            std::memcpy(little_endian, &number, 4);
            content.append(little_endian, 4);
        };
        constexpr std::size_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;
        word(kMagic), word(2), word(size);
        word(text.size()), word(kJson);
        content += text;
        word(bytes_.size()), word(kBinary);
        content.append(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
        write_text_file(file_, content);
    }

    const std::filesystem::path& file_;
    const Scene& scene_;
    std::vector<std::string>& left_out_;
    json root_;
    std::vector<std::byte> bytes_;
    std::map<std::vector<std::pair<int, int>>, std::size_t> meshes_;  ///< by mesh and material of their primitives
    std::map<int, json> attributes_;                                  ///< by index into Scene::meshes
    std::map<int, std::size_t> indices_;
    std::set<std::string> extensions_;
};

}  // namespace

void write_glb(const std::filesystem::path& file, const Scene& scene, std::vector<std::string>& left_out) {
    GlbWriter(file, scene, left_out).write();
}

}  // namespace pellucid
