#pragma once

#include <pellucid/environment.h>
#include <pellucid/scene.h>

#include <span>

namespace pellucid {

/// Each check throws Error naming the violated promise of the public headers. Loaders keep these promises; a caller
/// may build scenes by hand.
void check_scene(const Scene& scene);
void check_materials(const Scene& scene);
void check_objects(const Scene& scene);
void check_lights(std::span<const Light> lights);
void check_camera(const Camera& camera);
void check_environment(const Environment& environment);

/// True for finite transforms with a uniform scale. They preserve angles and hence the laws of refraction.
bool is_similarity(const glm::mat4& transform);

}  // namespace pellucid
