#pragma once

#include "scene/shells.h"

#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace pellucid {

/// The surfaces of a body, in the frame of its objects. Bodies of the same meshes share them.
struct BodySurface {
    std::vector<glm::vec3> positions;   ///< of all objects of the body, one after the other
    std::vector<glm::uvec3> triangles;  ///< alike
    std::vector<std::uint32_t> weld;    ///< weld_positions(positions)
    Shells shells;
    std::vector<std::uint32_t> first_vertex, first_triangle;  ///< per object of the body
    double volume = 0.0;  ///< where the winding number of the closed shells is above 0, m3
};

/// The objects that bound one solid of glass together.
struct Body {
    std::vector<std::uint32_t> objects;  ///< Scene::objects
    std::uint32_t material = 0;          ///< what the solid is made of: that of most of its surface
    /// Unique, from 0. Where bodies overlap, the one of the highest rank displaces the others: by Object::priority, then
    /// the one of less volume, then the later one. Volumes within a relative 1e-4 are equal.
    std::uint32_t rank = 0;
    std::shared_ptr<const BodySurface> surface;
};

inline constexpr std::uint32_t kNoBody = std::numeric_limits<std::uint32_t>::max();

struct Bodies {
    std::vector<Body> all;
    std::vector<std::uint32_t> of_object;  ///< per object, its body; kNoBody where it bounds no solid
};

/// Whether two materials fill solids with the same.
bool same_medium(const Material& a, const Material& b);

/// Of meshes in one frame.
BodySurface body_surface(std::span<const Mesh* const> meshes);

/// The bodies of a scene, as its vertices are now.
Bodies find_bodies(const Scene& scene);

/// Volume where the winding number of a surface's closed shells is above 0, m3. Where shells overlap, it is measured
/// along 256 x 256 lines.
double material_volume(const BodySurface& surface);

}  // namespace pellucid
