#include "scene/attenuation_hints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace pellucid {
namespace {

/// The longest side of a mesh's box, m.
float longest_side(const Mesh& mesh) {
    if (mesh.positions.empty()) return 0.0f;
    glm::vec3 low = mesh.positions.front(), high = low;
    for (const glm::vec3& p : mesh.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::vec3 size = high - low;
    return std::max({size.x, size.y, size.z});
}

}  // namespace

void hint_at_units(const Scene& scene, Warnings& warnings) {
    constexpr float kRatio = 1000.0f;
    struct Range {
        float smallest = std::numeric_limits<float>::infinity(), largest = 0.0f;
    };
    std::vector<Range> sizes(scene.materials.size());
    std::vector<float> sides(scene.meshes.size(), -1.0f);
    for (const Object& object : scene.objects) {
        const Material& material = scene.materials[std::size_t(object.material)];
        if (!material.refractive() || !std::isfinite(material.attenuation_distance) ||
            material.attenuation_color == glm::vec3(1.0f))
            continue;
        float& side = sides[std::size_t(object.mesh)];
        if (side < 0.0f) side = longest_side(scene.meshes[std::size_t(object.mesh)]);
        const float scale = std::cbrt(std::abs(glm::determinant(glm::mat3(object.world_from_object))));
        Range& range = sizes[std::size_t(object.material)];
        range.smallest = std::min(range.smallest, side * scale);
        range.largest = std::max(range.largest, side * scale);
    }
    for (std::size_t m = 0; m < sizes.size(); ++m) {
        const float distance = scene.materials[m].attenuation_distance;
        const Range& range = sizes[m];
        if (range.largest <= 0.0f) continue;
        // All objects of the material are far too small or far too large.
        const bool clear = range.largest * kRatio<distance, black = range.smallest> distance * kRatio;
        if (!clear && !black) continue;
        warnings.add(fmt::format(
            "material {}: its attenuation distance is {:.3g} m, its objects measure {:.3g} m: they "
            "will be {}; is the file in metres? --attenuation-distance sets another",
            scene.materials[m].name, distance, clear ? range.largest : range.smallest, clear ? "clear" : "black"));
    }
}

}  // namespace pellucid
