#pragma once

#include "gpu/volume_images.h"

#include <pellucid/scene.h>

namespace pellucid {

/// Uploads the volumes of a scene. Throws Error if they exceed the memory or the image size of the device.
VolumeImages upload_volumes(const Device& device, const Scene& scene);

/// Positions of boxes in one 3D image, and the size of the image. Boxes are arranged along z, then y, then x.
struct PackedBoxes {
    glm::uvec3 extent{1};
    std::vector<glm::uvec3> first;  ///< per box
};
/// Packs boxes of the given sizes. Throws Error if they do not fit into an image with sides of `limit`.
PackedBoxes pack_boxes(const std::vector<glm::uvec3>& sizes, std::uint32_t limit);

}  // namespace pellucid
