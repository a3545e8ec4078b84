#pragma once

#include <pellucid/environment.h>
#include <pellucid/scene.h>

#include <span>

namespace pellucid {

/// Throw Error naming what does not hold of the promises that the public headers state. Loaders keep
/// them; a caller may build these by hand.
void check_scene(const Scene& scene);
void check_materials(const Scene& scene);
void check_objects(const Scene& scene);
void check_lights(std::span<const Light> lights);
void check_camera(const Camera& camera);
void check_environment(const Environment& environment);

/// True for finite transforms that scale alike in all directions: angles stay what they are, and so do the laws of
/// refraction.
bool is_similarity(const glm::mat4& transform);

}  // namespace pellucid
