#pragma once

#include "gpu/memory.h"

#include <pellucid/environment.h>

#include <optional>

namespace pellucid {

/// How often directions are chosen when they are chosen by the light that comes from there: cells of an equirectangular grid,
/// for gpu/environment_shares.glsl (Pharr, Jakob & Humphreys, Physically Based Rendering, 4th ed., 2023, section 12.5).
struct EnvironmentShares {
    Buffer buffer;
    float luminance;  ///< W/m2, integral over all directions
};

/// Of the environment's mean luminance per cell, 256 x 128 cells at most. None if the environment is black.
std::optional<EnvironmentShares> tabulate_environment(const Device& device, const Environment& environment);

}  // namespace pellucid
