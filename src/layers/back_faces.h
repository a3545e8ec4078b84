#pragma once

#include "layers/layers.h"

namespace pellucid {

/// Which surface stands for the far side of the glass, where techniques look at one only.
enum class BackFace : std::uint32_t {
    kFirst,     ///< the nearest that a view ray leaves a solid through
    kFarthest,  ///< the last
};

/// Per pixel, a surface that the view ray leaves a solid through; as a layer of Layers, with one layer.
struct BackFaces {
    const GpuImage& depth;
    const GpuImage& triangle;
    const GpuImage& normal;
};

/// One geometry pass over `solids`. Opaque surfaces hide nothing.
BackFaces draw_back_faces(Recorder& recorder, const Frame& frame, std::span<const DrawCall> solids, BackFace which);

}  // namespace pellucid
