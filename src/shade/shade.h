#pragma once

#include "layers/layers.h"
#include "techniques/technique.h"

#include <pellucid/display.h>

#include <functional>

namespace pellucid {

/// Draws opaque objects as glTF's metallic-roughness materials under the environment (gpu/opaque_surface.glsl), as if each
/// point of a surface saw all of it: no shadows, no light from other surfaces. Unlit materials as they are, emission added.
Opaque draw_opaque(Recorder& recorder, const Frame& frame);

/// What the depths of the caller's depth image mean.
struct CallersDepths {
    glm::vec4 z_and_w;  ///< of the projection: clip z is x z + y, clip w is z z + w, by z along the view's axis, m
    float far_depth;    ///< of texels where nothing was drawn
};
/// Distances along the view's axis, m (R32F), of depths that lie row by row in `stored`; PELLUCID_EMPTY_DEPTH where nothing was
/// drawn.
const GpuImage& import_depth(Recorder& recorder, const Frame& frame, const Buffer& stored,
                             const CallersDepths& meaning);

/// What thin walls in front do to light on its way.
struct ThinWalls {
    const GpuImage& thin_tint;        ///< RGBA16F: transmittance of all of them
    const GpuImage& thin_reflection;  ///< RGBA16F: environment that they reflect
};

/// Thin-walled glass does not bend light: its panes are multiplied together in any order. Their
/// reflections are added, without the little that one pane takes from the reflection of another.
ThinWalls draw_thin_walls(Recorder& recorder, const Frame& frame, const Opaque& opaque, const Layers& layers);

/// Scene-linear radiance (RGBA32F): glass lit through its refraction, plus the first interface's
/// reflection of the environment; opaque surfaces; the environment behind.
const GpuImage& shade(Recorder& recorder, const Frame& frame, const Opaque& opaque, const Layers& layers,
                      const ThinWalls& walls, const Refraction& refraction, View view);

/// Twin in count_events.comp. Pixels with glass, by Status, and those where shading and geometric normal disagreed about the side.
struct EventCounts {
    std::uint32_t side_conflicts;
    std::uint32_t statuses[7];
};
/// Counts those of a frame; `then` gets them once it has run.
void count_events(Recorder& recorder, const Frame& frame, const Refraction& refraction,
                  std::function<void(const EventCounts&)> then);

/// Adds `radiance` to the sum of the samples before it; `sample` 0 starts a new sum. Where pixels want different numbers
/// of samples (`wanted`), to the mean of each. Sums of different names are apart.
const GpuImage& accumulate(Recorder& recorder, const Frame& frame, const GpuImage& radiance, std::uint32_t sample,
                           const GpuImage* wanted = nullptr, std::string_view name = "radiance sum");

/// Display values (RGBA8, sRGB-encoded) of `scale * radiance`, by a curve other than kKrawczyk (adaptation.h).
/// `swap_red_blue`: as BGRA8.
const GpuImage& tonemap(Recorder& recorder, const Frame& frame, const GpuImage& radiance, float scale, ToneMap curve,
                        bool swap_red_blue = false);

/// `scale * radiance` (RGBA32F), alpha 1.
const GpuImage& scale_radiance(Recorder& recorder, const Frame& frame, const GpuImage& radiance, float scale);

}  // namespace pellucid
