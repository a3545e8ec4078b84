#pragma once

#include "scene/gltf_file.h"
#include "scene/gltf_textures.h"

#include <pellucid/scene.h>

#include <vector>

namespace pellucid {

/// Reads all materials of a glTF file into scene.materials, in the file's order, and the images
/// that they need into scene.images. Values out of range are clamped; that, and everything that is
/// not drawn as the material says, gives a warning with the material's name. Returns, by material, the sets of texture
/// coordinates that Mesh::texcoords is to hold.
std::vector<TexcoordSets> read_gltf_materials(const GltfFile& gltf, Scene& scene, Warnings& warnings);

/// What primitives without a material get (glTF 2.0, section 3.9.1 and its defaults).
Material default_gltf_material();

}  // namespace pellucid
