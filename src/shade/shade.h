#pragma once

#include "layers/layers.h"
#include "techniques/technique.h"

#include <pellucid/display.h>

#include <functional>

namespace pellucid {

/// Draws opaque objects as glTF's metallic-roughness materials under the environment (gpu/opaque_surface.glsl),
/// without shadows or light from other surfaces. Unlit materials show their colour unchanged. Emission is added.
Opaque draw_opaque(Recorder& recorder, const Frame& frame);

/// Interpretation of the caller's depth image.
struct CallersDepths {
    glm::vec4 z_and_w;  ///< of the projection: clip z = x z + y, clip w = z z + w, for z along the view axis, m
    float far_depth;    ///< depth of texels without geometry
};
/// Distances along the view axis, m (R32F), of the depths in `stored`, which is in row order. PELLUCID_EMPTY_DEPTH
/// where the caller has drawn nothing.
const GpuImage& import_depth(Recorder& recorder, const Frame& frame, const Buffer& stored,
                             const CallersDepths& meaning);

/// Effect of the thin walls in front on light from behind.
struct ThinWalls {
    const GpuImage& thin_tint;        ///< RGBA16F: transmittance of all panes
    const GpuImage& thin_reflection;  ///< RGBA16F: environment reflected by the panes
};

/// Thin-walled glass does not bend light: the transmittances of panes are multiplied in any order. Their reflections
/// are added; the attenuation of one pane's reflection by another is ignored.
ThinWalls draw_thin_walls(Recorder& recorder, const Frame& frame, const Opaque& opaque, const Layers& layers);

/// Scene-linear radiance (RGBA32F): glass by its refraction, plus the first interface's reflection of the environment;
/// opaque surfaces; the environment behind.
const GpuImage& shade(Recorder& recorder, const Frame& frame, const Opaque& opaque, const Layers& layers,
                      const ThinWalls& walls, const Refraction& refraction, View view);

/// Twin in count_events.comp. Counts of pixels with glass by Status, and of disagreements of shading and geometric
/// normals about the side.
struct EventCounts {
    std::uint32_t side_conflicts;
    std::uint32_t statuses[7];
};
/// Counts the events of a frame. `then` receives the counts after the frame has run.
void count_events(Recorder& recorder, const Frame& frame, const Refraction& refraction,
                  std::function<void(const EventCounts&)> then);

/// Adds `radiance` to the sum of the previous samples; `sample` 0 starts a new sum. With `wanted` (samples per pixel),
/// adds to each pixel's mean instead. Sums of different names are separate.
const GpuImage& accumulate(Recorder& recorder, const Frame& frame, const GpuImage& radiance, std::uint32_t sample,
                           const GpuImage* wanted = nullptr, std::string_view name = "radiance sum");

/// Display values (RGBA8, sRGB-encoded) of `scale * radiance`, by any curve except kKrawczyk (adaptation.h).
/// `swap_red_blue`: output BGRA8.
const GpuImage& tonemap(Recorder& recorder, const Frame& frame, const GpuImage& radiance, float scale, ToneMap curve,
                        bool swap_red_blue = false);

/// `scale * radiance` (RGBA32F), alpha 1.
const GpuImage& scale_radiance(Recorder& recorder, const Frame& frame, const GpuImage& radiance, float scale);

}  // namespace pellucid
