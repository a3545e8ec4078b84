#pragma once

#include "scene/gltf_file.h"

#include <pellucid/image.h>
#include <pellucid/scene.h>

#include <optional>
#include <string>
#include <vector>

namespace pellucid {

/// Decodes the images of a glTF file that its materials use, several at a time.
///
/// Materials are read twice. Up to decode_noted(), every image that is asked for counts as index 0 and is noted; what
/// was read so far is of no use. From then on indices are those of the scene.
class GltfImages {
public:
    GltfImages(const GltfFile& gltf, Scene& scene, Warnings& warnings);

    /// As many at once as there are cores, so that no more than that are in memory twice.
    void decode_noted();

    /// Index into Scene::images, -1 with a warning that names `user` if it cannot be decoded.
    int index(int gltf_image, const std::string& user);

    /// An image to compute with; null before decode_noted(), and with a warning if it cannot be decoded. It is valid
    /// until an image is added to the scene.
    const Image* decoded(int gltf_image, const std::string& user);

    /// Index into Scene::images of an image that was computed.
    int add(Image image, const std::string& name);

    bool noting() const { return noting_; }

    /// Warns if the image cannot be had, without decoding it.
    void expect(int gltf_image, const std::string& user);

private:
    struct Entry {
        std::optional<Image> image;  ///< until it moves to the scene
        std::string problem;         ///< why it cannot be decoded
        int index = -1;              ///< into Scene::images
        bool noted = false;
        bool warned = false;
    };
    void decode(std::size_t gltf_image);
    /// Whether an image is there, decoded; else a warning.
    bool have(int gltf_image, const std::string& user);

    const GltfFile& gltf_;
    Scene& scene_;
    Warnings& warnings_;
    std::vector<Entry> entries_;  ///< one per image of the file
    bool noting_ = true;
};

}  // namespace pellucid
