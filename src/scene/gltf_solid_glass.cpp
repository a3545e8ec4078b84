#include "scene/gltf_solid_glass.h"

#include "scene/mesh_repair.h"
#include "scene/shells.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace pellucid {
namespace {

constexpr std::size_t kMostNames = 4;  // in a warning

bool closed(const std::vector<SolidGlass::Part>& parts) {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    for (const SolidGlass::Part& part : parts) {
        const glm::uvec3 first(std::uint32_t(positions.size()));
        positions.insert(positions.end(), part.mesh->positions.begin(), part.mesh->positions.end());
        for (const glm::uvec3 t : part.mesh->triangles) triangles.push_back(t + first);
    }
    if (triangles.empty() || !find_shells(positions, triangles, weld_positions(positions)).all_closed()) return false;
    // Two sheets back to back are closed, too, but bound nothing.
    return signed_volume(positions, triangles).meaningful();
}

}  // namespace

void SolidGlass::apply(const std::vector<Part>& primitives) {
    std::vector<Part> thin;
    for (const Part& part : primitives) {
        const Material& material = scene_.materials[std::size_t(*part.material)];
        if (material.transmissive() && !material.refractive()) thin.push_back(part);
    }
    if (thin.empty()) return;
    const bool together = closed(thin);
    for (const Part& part : thin)
        if (together || (thin.size() > 1 && closed({part}))) apply_closed(part);
}

void SolidGlass::apply_closed(const Part& part) {
    const Material& thin = scene_.materials[std::size_t(*part.material)];
    if (!make_) {
        thin_.insert(*part.material);
        return;
    }
    const auto known = twin_.find(*part.material);
    if (known != twin_.end()) {
        *part.material = known->second;
        return;
    }
    Material solid = thin;
    solid.thickness = 1.0f;
    if (solid.alpha_is_coverage && solid.base_color.a < 1.0f)
        warnings_.add(fmt::format("material {}: alpha is left out, solid glass is drawn at full coverage", solid.name));
    solid.alpha_is_coverage = false;
    const int twin = static_cast<int>(scene_.materials.size());
    scene_.materials.push_back(std::move(solid));
    twin_[*part.material] = twin;
    *part.material = twin;
}

void SolidGlass::warn() {
    if (thin_.empty()) return;
    std::vector<std::string> names;
    for (const int material : thin_) names.push_back(scene_.materials[std::size_t(material)].name);
    std::string more;
    if (names.size() > kMostNames) {
        more = fmt::format(" and {} more", names.size() - kMostNames);
        names.resize(kMostNames);
    }
    const bool one = names.size() == 1;
    warnings_.add(
        fmt::format("material{} {}{}: without a volume {} drawn as thin sheets that do not bend light; the "
                    "meshes are closed, --solid makes them solid glass",
                    one ? "" : "s", fmt::join(names, ", "), more, one ? "it is" : "they are"));
}

}  // namespace pellucid
