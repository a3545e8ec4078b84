#pragma once

#include "gpu/frame.h"
#include "gpu/recorder.h"

namespace pellucid {

/// Draws patches of wavefronts (gpu::ShownPatch) over the scene in `radiance` (RGBA32F), which is dimmed. The colour of
/// a patch shows its brightness (front_color.glsl). Opaque surfaces (`opaque_depth`, m) hide patches behind them.
/// `exposure`: factor of the irradiance and of the scene's radiance. Ihrke et al. 2007, figure 5.
void draw_wavefronts(Recorder& recorder, const Frame& frame, const Buffer& shown, const GpuImage& opaque_depth,
                     const GpuImage& radiance, float exposure);

}  // namespace pellucid
