#pragma once

#include "scene/gltf_file.h"

#include <pellucid/image.h>
#include <pellucid/scene.h>

#include <optional>
#include <string>
#include <vector>

namespace pellucid {

/// Decodes the images of a glTF file when they are first asked for.
class GltfImages {
public:
    GltfImages(const GltfFile& gltf, Scene& scene, Warnings& warnings);

    /// Index into Scene::images, -1 with a warning that names `user` if it cannot be decoded.
    int index(int gltf_image, const std::string& user);

    /// Warns if the image cannot be had, without decoding it.
    void expect(int gltf_image, const std::string& user);

private:
    std::optional<Image> decode(int gltf_image, const std::string& user);
    void warn(int gltf_image, const std::string& user, const std::string& problem);

    const GltfFile& gltf_;
    Scene& scene_;
    Warnings& warnings_;
    std::vector<int> index_;  ///< into Scene::images; kUnknown before the first use
    std::vector<char> warned_;
};

}  // namespace pellucid
