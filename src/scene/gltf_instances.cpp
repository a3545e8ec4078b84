// EXT_mesh_gpu_instancing (Khronos Group, glTF extensions/2.0/Vendor/EXT_mesh_gpu_instancing, 2020).
#include "scene/gltf_instances.h"

#include "core/fail.h"
#include "core/math.h"
#include "scene/gltf_accessor.h"
#include "scene/gltf_properties.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

int accessor_of(const tinygltf::Value& attributes, const char* name) {
    if (!attributes.Has(name) || !attributes.Get(name).IsNumber()) return -1;
    return gltf_integer(attributes.Get(name));
}

/// An accessor without data has zeros, which cost nothing in the file but memory here.
void check_count(const GltfFile& gltf, int accessor, const std::string& user, std::size_t most) {
    if (accessor < 0 || std::size_t(accessor) >= gltf.model.accessors.size()) return;  // reported when it is read
    const tinygltf::Accessor& values = gltf.model.accessors[std::size_t(accessor)];
    if (values.count > most)
        fail(gltf.path, fmt::format("{}: its {} instances make more than {} in the scene; join them to one mesh", user,
                                    values.count, kMostInstances));
    if (values.bufferView < 0 && !values.sparse.isSparse)
        fail(gltf.path, fmt::format("{}: accessor {} of its instances has no data", user, accessor));
}

void warn_of_custom(const tinygltf::Value& attributes, const std::string& user, Warnings& warnings) {
    std::vector<std::string> names = attributes.Keys();
    std::erase_if(
        names, [](const std::string& name) { return name == "TRANSLATION" || name == "ROTATION" || name == "SCALE"; });
    if (!names.empty())
        warnings.add(fmt::format("{}: attributes of its instances left out: {}", user, fmt::join(names, ", ")));
}

}  // namespace

std::optional<std::vector<glm::dmat4>> gltf_instances(const GltfFile& gltf, int node, const std::string& user,
                                                      std::size_t most, Warnings& warnings) {
    const tinygltf::Node& from = gltf.model.nodes[std::size_t(node)];
    const auto extension = from.extensions.find(kInstancing);
    if (extension == from.extensions.end() || !extension->second.IsObject() || !extension->second.Has("attributes") ||
        !extension->second.Get("attributes").IsObject())
        return std::nullopt;
    if (from.skin >= 0) {
        warnings.add(fmt::format("{}: instances of a mesh with a skin are left out", user));
        return std::nullopt;
    }
    const tinygltf::Value& attributes = extension->second.Get("attributes");
    const int translation = accessor_of(attributes, "TRANSLATION"), rotation = accessor_of(attributes, "ROTATION"),
              scale = accessor_of(attributes, "SCALE");
    for (const int accessor : {translation, rotation, scale}) check_count(gltf, accessor, user, most);
    warn_of_custom(attributes, user, warnings);
    std::vector<float> translations, rotations, scales;
    if (translation >= 0) translations = read_fractions(gltf, translation, 3, user + " instances TRANSLATION");
    if (rotation >= 0) rotations = read_fractions(gltf, rotation, 4, user + " instances ROTATION");
    if (scale >= 0) scales = read_fractions(gltf, scale, 3, user + " instances SCALE");
    if (translations.empty() && rotations.empty() && scales.empty()) {
        if (translation >= 0 || rotation >= 0 || scale >= 0) return std::vector<glm::dmat4>();
        warnings.add(fmt::format("{}: its instances have no transforms, the mesh is drawn once", user));
        return std::nullopt;
    }

    const std::size_t count = std::max({translations.size() / 3, rotations.size() / 4, scales.size() / 3});
    const auto fits = [&](const std::vector<float>& values, std::size_t width) {
        return values.empty() || values.size() == count * width;
    };
    if (!fits(translations, 3) || !fits(rotations, 4) || !fits(scales, 3))
        fail(gltf.path, fmt::format("{}: its instances have {} translations, {} rotations and {} scales; all must be "
                                    "as many",
                                    user, translations.size() / 3, rotations.size() / 4, scales.size() / 3));
    std::vector<glm::dmat4> node_from_mesh;
    node_from_mesh.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        glm::dmat4 m(1.0);
        if (!translations.empty()) m = glm::translate(m, glm::dvec3(glm::make_vec3(&translations[i * 3])));
        if (!rotations.empty()) {
            const float* const r = &rotations[i * 4];
            const glm::dquat q(r[3], r[0], r[1], r[2]);
            const double length = glm::length(q);
            if (!(length > 0.0)) fail(gltf.path, fmt::format("{}: rotation of instance {} is zero", user, i));
            m *= glm::mat4_cast(q / length);
        }
        if (!scales.empty()) m = glm::scale(m, glm::dvec3(glm::make_vec3(&scales[i * 3])));
        node_from_mesh.push_back(m);
    }
    return node_from_mesh;
}

}  // namespace pellucid
