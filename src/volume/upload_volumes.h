#pragma once

#include "gpu/volume_images.h"

#include <pellucid/scene.h>

namespace pellucid {

/// The volumes of a scene on the device. Gradients are central differences (one-sided at the faces). Throws Error if the
/// device cannot hold them.
VolumeImages upload_volumes(const Device& device, const Scene& scene);

/// Where boxes of given sizes lie in one 3D image, and how large that is: beside each other along z, then y, then x.
struct PackedBoxes {
    glm::uvec3 extent{1};
    std::vector<glm::uvec3> first;  ///< per box
};
/// Throws Error if no side may be longer than `limit` and they do not fit.
PackedBoxes pack_boxes(const std::vector<glm::uvec3>& sizes, std::uint32_t limit);

}  // namespace pellucid
