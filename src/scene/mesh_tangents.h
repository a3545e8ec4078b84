#pragma once

#include "scene/warnings.h"

#include <pellucid/scene.h>

#include <vector>

namespace pellucid {

/// Tangents of vertices from texture coordinates: the mean over the triangles around each, by their angles there, as
/// Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008, has them. A zero vector where triangles of both
/// handednesses meet, or none has texture coordinates of use.
std::vector<glm::vec4> make_tangents(const Mesh& mesh, int texcoord_set);

/// Gives tangents to the meshes whose materials need some, but for meshes that deform (`deforming`, one per mesh or none).
/// Warns of meshes that lack the texture coordinates.
void add_tangents(Scene& scene, const std::vector<char>& deforming, Warnings& warnings);

}  // namespace pellucid
