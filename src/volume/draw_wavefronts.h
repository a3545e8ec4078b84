#pragma once

#include "gpu/frame.h"
#include "gpu/recorder.h"

namespace pellucid {

/// Draws the patches of wavefronts (gpu::ShownPatch) over what `radiance` (RGBA32F) shows of the scene, which is dimmed.
/// Their colour says how bright their light is (front_color.glsl); what `opaque_depth` (m) has before them hides them.
/// `exposure`: factor of the irradiance and of the scene's radiance. Ihrke et al. 2007, figure 5.
void draw_wavefronts(Recorder& recorder, const Frame& frame, const Buffer& shown, const GpuImage& opaque_depth,
                     const GpuImage& radiance, float exposure);

}  // namespace pellucid
