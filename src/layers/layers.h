#pragma once

#include "gpu/frame.h"

namespace pellucid {

/// Per pixel, the glass surfaces that the view ray crosses, nearest first.
///
/// Layer k of `depth` (R32F) holds linear eye depth in metres, PELLUCID_EMPTY_DEPTH where there is
/// no k-th surface; layer k of `surface` (RG32UI) holds the interpolated world normal (octahedral)
/// and the triangle: its index over all objects, with PELLUCID_BACK_FACE set where the view ray
/// leaves the solid. The object follows from the triangle (find_object in objects.glsl).
///
/// Order is by depth and, where depths are equal, by triangle index, in every builder. A pixel whose
/// first surface lies behind an opaque one has no layers; opaque surfaces further back cut nothing.
struct Layers {
    const GpuImage& depth;
    const GpuImage& surface;
    std::uint32_t count;
};

/// One geometry pass per layer: Everitt, "Interactive Order-Independent Transparency", NVIDIA 2001.
/// `opaque_depth` is R32F, PELLUCID_EMPTY_DEPTH where nothing opaque is seen.
Layers peel_layers(Recorder& recorder, const Frame& frame, std::uint32_t count, const GpuImage& opaque_depth);

/// Room for the fragments of single_pass_layers(). Kept from frame to frame; grows by measurement.
struct FragmentPool {
    std::uint32_t capacity = 0;  ///< fragments; 0: choose
    std::uint32_t bands = 1;     ///< the picture is done in this many horizontal bands
};

/// One geometry pass for all layers: per-pixel linked lists (Yang et al., "Real-Time Concurrent
/// Linked List Construction on the GPU", EGSR 2010), of which a compute pass selects the `count`
/// nearest. Needs Device::fragment_atomics(). After the frame ask fragment_pool_overflowed().
Layers single_pass_layers(Recorder& recorder, const Frame& frame, std::uint32_t count, const GpuImage& opaque_depth,
                          FragmentPool& pool);

/// True if the last single_pass_layers() ran out of room: `pool` has been enlarged (by more memory
/// or, where the device's binding limit is reached, by more bands) and the frame must be recorded
/// again. Throws Error if one row of pixels alone is too much for the device.
bool fragment_pool_overflowed(const Frame& frame, FragmentPool& pool);

}  // namespace pellucid
