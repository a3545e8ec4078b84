#pragma once

#include "layers/layers.h"

namespace pellucid {

/// The images that a request's layers go into.
struct LayerImages {
    const GpuImage& depth;
    const GpuImage& triangle;
    const GpuImage& normal;
};
LayerImages allocate_layers(const Frame& frame, const LayerRequest& request);

/// Fills in the normals of the triangles that stand in `images`; returns the list of the pixels that have any.
const Buffer& resolve_normals(Recorder& recorder, const Frame& frame, const LayerImages& images,
                              const LayerRequest& request);

/// Layers whose depths and triangles stand in `images`.
Layers finish_layers(Recorder& recorder, const Frame& frame, const LayerImages& images, const Opaque& opaque,
                     const LayerRequest& request, LayerSource& source);

}  // namespace pellucid
