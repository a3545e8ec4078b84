#pragma once

#include "layers/layers.h"

namespace pellucid {

/// The surface that represents the far side of the glass in techniques that use only one.
enum class BackFace : std::uint32_t {
    kFirst,     ///< nearest surface through which the view ray leaves a solid
    kFarthest,  ///< farthest such surface
};

/// Per pixel, a surface through which the view ray leaves a solid. The images are those of Layers, with one layer.
struct BackFaces {
    const GpuImage& depth;
    const GpuImage& triangle;
    const GpuImage& normal;
};

/// One geometry pass over `solids`. Opaque surfaces hide nothing.
BackFaces draw_back_faces(Recorder& recorder, const Frame& frame, std::span<const DrawCall> solids, BackFace which);

}  // namespace pellucid
