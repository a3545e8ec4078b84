#pragma once

#include <pellucid/api.h>
#include <pellucid/scene.h>

#include <filesystem>
#include <string>
#include <vector>

namespace pellucid {

/// Writes a scene as it is: loaded, repaired, posed and edited. The extension of `file` chooses the format.
///
/// `.glb` (glTF 2.0, binary): objects, materials with their extensions, images as 8-bit PNG, cameras and lights.
/// load_scene() of it gives the same images, but for rounding. Left out are volumes and animations.
///
/// `.obj`: triangles in the world's frame, and a `.mtl` file beside with a material for each object; textures of base
/// colour, emission and normals are PNG files beside. Left out is what MTL has no word for: attenuation, dispersion,
/// finishes, translucency, cameras and lights.
///
/// The files appear complete or not at all, the `.obj` last. Returns one line for each thing left out. Throws Error
/// naming the file if it cannot be written or the extension is another.
PELLUCID_API std::vector<std::string> write_scene(const std::filesystem::path& file, const Scene& scene);

}  // namespace pellucid
