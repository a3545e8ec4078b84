#pragma once

#include "scene/gltf_file.h"
#include "scene/gltf_images.h"

#include <pellucid/scene.h>

#include <array>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace pellucid {

/// Sets of texture coordinates of the file that Mesh::texcoords holds for a material.
using TexcoordSets = std::array<int, 2>;

/// Reads the textures of materials, one material after the other, twice (GltfImages).
class GltfTextures {
public:
    GltfTextures(const GltfFile& gltf, Scene& scene, Warnings& warnings);

    /// Begins a material; `user` names it in messages.
    void begin(std::size_t material, const std::string& user);

    /// A texture of the material, called `what` in messages; without an image, and with a warning, if it cannot be had.
    Texture texture(const tinygltf::TextureInfo& info, const char* what);

    /// The same without its image, for images that are computed from it.
    Texture reference(const tinygltf::TextureInfo& info, const char* what);

    /// Warns if a texture that is not drawn cannot be had.
    void expect(int texture_index);

    /// Whether an image of the material is in a format that cannot be decoded at all.
    bool lacks_basis() const { return lacks_basis_; }

    /// Decodes what was asked for. The materials are to be read again.
    void begin_again();

    /// Warns about what all materials together lack.
    void warn_about_leftovers();

    /// By material: the sets of texture coordinates that its textures refer to.
    const std::vector<TexcoordSets>& sets() const { return sets_; }

    GltfImages& images() { return images_; }
    /// Index of the image behind a texture; -1 if there is none, kBasis if it is of KTX2, which is not decoded.
    int image_of(int texture_index);
    static constexpr int kBasis = -2;

private:
    int slot_of(int texcoord_set);
    void read_sampler(int index, Texture& texture) const;
    glm::mat3 uv_transform(const tinygltf::ExtensionMap& extensions);

    const GltfFile& gltf_;
    GltfImages images_;
    Warnings& warnings_;
    std::size_t material_ = 0;
    std::string user_;
    bool lacks_basis_ = false;
    std::set<int> basis_textures_;              ///< left out
    std::vector<std::vector<int>> asked_sets_;  ///< by material, in the order in which they were asked for
    std::vector<TexcoordSets> sets_;
};

}  // namespace pellucid
