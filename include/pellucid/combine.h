#pragma once

#include <pellucid/api.h>
#include <pellucid/scene.h>

#include <glm/glm.hpp>

namespace pellucid {

/// Appends the objects of another scene, with their meshes, materials and images. `scene_from_added` places them: affine
/// and invertible. Lights, cameras, volumes and animations are left out. Returns the index of the first new object.
PELLUCID_API int append_objects(Scene& scene, const Scene& added, const glm::mat4& scene_from_added);

}  // namespace pellucid
