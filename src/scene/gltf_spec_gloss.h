#pragma once

#include "scene/gltf_textures.h"

#include <pellucid/scene.h>

#include <map>
#include <string>
#include <tuple>
#include <utility>

namespace pellucid {

/// Converts materials of KHR_materials_pbrSpecularGlossiness to metallic-roughness, textures texel by texel.
class SpecularGlossiness {
public:
    SpecularGlossiness(const GltfFile& gltf, GltfTextures& textures, Warnings& warnings)
        : gltf_(gltf), textures_(textures), warnings_(warnings) {}

    /// Sets base colour, metallic, roughness and their textures. Returns whether the material has the extension.
    bool read(const tinygltf::Material& from, const std::string& user, Material& material);

    /// Says once how many materials were converted.
    void warn_about_conversions();

private:
    using Key = std::tuple<int, int, float, float, float, float, float, float, float>;
    struct Factors {
        glm::vec4 diffuse{1.0f};
        glm::vec3 specular{1.0f};
        float glossiness = 1.0f;
    };
    struct Images {
        int diffuse = -1, specular_glossiness = -1;  ///< of the file
        bool mean = false;                           ///< of the second only its mean is used
    };
    /// Whether the pixels of both, of the larger width and height, are no more than kMaxPixels.
    bool fit_together(const Images& images, const std::string& user);
    std::pair<int, int> converted(const Images& images, const Factors& factors, const std::string& user);

    const GltfFile& gltf_;
    GltfTextures& textures_;
    Warnings& warnings_;
    std::map<Key, std::pair<int, int>> known_;  ///< base colour and metallic-roughness, Scene::images
    int count_ = 0;
};

}  // namespace pellucid
