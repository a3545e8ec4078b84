#pragma once

#include "gpu/memory.h"

#include <pellucid/environment.h>

#include <optional>

namespace pellucid {

/// Probabilities of directions in proportion to the environment's light, for gpu/environment_shares.glsl. They are
/// tabulated in cells of an equirectangular grid (Pharr, Jakob & Humphreys, Physically Based Rendering, 4th ed., 2023,
/// section 12.5).
struct EnvironmentShares {
    Buffer buffer;
    float luminance;  ///< W/m2, integral over all directions
};

/// Tabulates the environment's mean luminance in up to 256 x 128 cells. Returns nullopt if the environment is black.
std::optional<EnvironmentShares> tabulate_environment(const Device& device, const Environment& environment);

}  // namespace pellucid
