#pragma once

// Directions that textures give, at a point of a surface: glTF 2.0, section 3.9.3 (normal textures).

#include "reference/geometry.h"
#include "reference/texture_lookup.h"

#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <optional>

namespace pellucid::reference {

/// Axes in the world: u of the texture coordinates, -v, and the outward normal. None where texture coordinates do not say.
std::optional<glm::dmat3> tangent_frame(const Geometry& geometry, const Hit& hit, const glm::dvec3& normal,
                                        int texcoord_set);

/// The outward unit normal as a texture tilts it; `normal` itself, bit for bit, where the texture is flat.
glm::dvec3 tilted_normal(const Scene& scene, const Geometry& geometry, const Hit& hit, const glm::dvec3& normal,
                         const Texture& texture, double scale, const SurfaceAttributes& attributes);

/// A tilted normal, bent as little as the mirrored `to_viewer` needs to stay above the triangle. `flat`: the triangle's
/// normal, on the viewer's side as the other is.
glm::dvec3 mirroring_above(const glm::dvec3& normal, const glm::dvec3& flat, const glm::dvec3& to_viewer);

}  // namespace pellucid::reference
