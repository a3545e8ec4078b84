#pragma once

#include <pellucid/api.h>

#include <string_view>

namespace pellucid {

/// Quantity that an image shows.
enum class View {
    kRadiance,
    /// Interfaces on each path (Wang 2014, figure 4.5): red up to two, blue more, green total internal reflection.
    /// Grey marks paths that the technique abandoned (status other than ok).
    kAnalysis,
    /// Wavefronts of light at equal optical lengths, over a dimmed image of the scene. The colour shows irradiance in
    /// W/m2, times 2^exposure_ev, on a logarithmic scale: 1/16 dark blue, 1/4 blue, 1 white, 4 orange, 16 and more
    /// red. Fainter light is not shown. Needs lights, volumes and a technique that traces wavefronts (ihrke-2007).
    kWavefront,
};

/// The view with this name: radiance, analysis, wavefront. Throws Error listing the names.
PELLUCID_API View parse_view(std::string_view name);

/// Curves from scene-linear radiance to display values. Each ends with the sRGB curve.
enum class ToneMap {
    kNone,      ///< clips to 0..1
    kReinhard,  ///< L / (1 + L) on luminance (Reinhard et al. 2002)
    kAces,      ///< Narkowicz 2015, fit of the ACES filmic curve
    kNeutral,   ///< Khronos PBR Neutral 1.0: keeps base colours, compresses highlights (default)
    kKrawczyk,  ///< eye adaptation (Krawczyk et al. 2005); needs luminances, see RenderSettings
};

/// The tone map with this name: none, reinhard, aces, neutral, krawczyk. Throws Error listing the names.
PELLUCID_API ToneMap parse_tonemap(std::string_view name);

}  // namespace pellucid
