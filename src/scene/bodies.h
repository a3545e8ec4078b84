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

/// The surfaces of a body, in the frame of its objects. Bodies of the same meshes share one BodySurface.
struct BodySurface {
    std::vector<glm::vec3> positions;   ///< positions of all objects of the body, concatenated
    std::vector<glm::uvec3> triangles;  ///< triangles of all objects of the body, concatenated
    std::vector<std::uint32_t> weld;    ///< weld_positions(positions)
    Shells shells;
    std::vector<std::uint32_t> first_vertex, first_triangle;  ///< per object of the body
    double volume = 0.0;  ///< m3, where the winding number of the closed shells is above 0
};

/// The objects that together bound one solid of glass.
struct Body {
    std::vector<std::uint32_t> objects;  ///< indices into Scene::objects
    std::uint32_t material = 0;          ///< material of the solid: the material with the largest share of its surface
    /// Unique, from 0. Where bodies overlap, the body of the highest rank displaces the others. Ranks order by
    /// Object::priority, then smaller volume, then later position in the file. Volumes within a relative 1e-4 count as
    /// equal.
    std::uint32_t rank = 0;
    std::shared_ptr<const BodySurface> surface;
};

inline constexpr std::uint32_t kNoBody = std::numeric_limits<std::uint32_t>::max();

struct Bodies {
    std::vector<Body> all;
    std::vector<std::uint32_t> of_object;  ///< per object, its body; kNoBody if it bounds no solid
};

/// True if two materials have equal media.
bool same_medium(const Material& a, const Material& b);

/// The surface of a body whose meshes lie in one frame.
BodySurface body_surface(std::span<const Mesh* const> meshes);

/// The bodies of a scene, for its current vertices.
Bodies find_bodies(const Scene& scene);

/// Volume, m3, where the winding number of a surface's closed shells is above 0. For overlapping shells it is
/// integrated along 256 x 256 lines.
double material_volume(const BodySurface& surface);

}  // namespace pellucid
