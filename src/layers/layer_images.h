#pragma once

#include "layers/layers.h"

namespace pellucid {

/// The images that store the layers of a request.
struct LayerImages {
    const GpuImage& depth;
    const GpuImage& triangle;
    const GpuImage& normal;
};
LayerImages allocate_layers(const Frame& frame, const LayerRequest& request);

/// Computes the normals of the triangles in `images`. Returns the list of pixels that have layers.
const Buffer& resolve_normals(Recorder& recorder, const Frame& frame, const LayerImages& images,
                              const LayerRequest& request);

/// Completes layers whose depths and triangles are in `images`.
Layers finish_layers(Recorder& recorder, const Frame& frame, const LayerImages& images, const Opaque& opaque,
                     const LayerRequest& request, LayerSource& source);

}  // namespace pellucid
