#pragma once

#include "techniques/technique.h"

#include <array>

namespace pellucid {

extern const Technique kVisibilityLayers;

/// Of follow_paths().
inline constexpr std::array kPathParameters = {
    ParameterInfo{"events", "", 16, 1, 4095, true, "refractions and reflections followed along a path"},
    ParameterInfo{"branches", "", -1, -1, 255, true,
                  "reflected ways followed per pixel and sample; -1: none in a picture of one sample, 16 otherwise"},
    ParameterInfo{"threshold", "", 0.01, 0, 1, false, "share of the light that a reflected way carries at least"},
    ParameterInfo{"one-branch", "", 0, 0, 1, true,
                  "1: each sample takes one way at random, refracted or reflected, and through rough glass one facet"},
    ParameterInfo{"surfaces-per-pass", "", 0, 0, 64, true,
                  "surfaces that a path meets in one dispatch, a matter of time; 0: chosen for the device"},
    ParameterInfo{"layers", "", 1, 1, 64, true,
                  "surfaces along a view ray that the AOV `layers` counts at most; paths look at all that there are"},
};

/// Technique::prepare of techniques that call it.
void prepare_paths(const Preparation& preparation, const ParameterValues& parameters);
/// Follows the view rays through `map`, from the first surface of `layers` on.
Refraction follow_paths(Recorder& recorder, const Frame& frame, const Layers& layers, const SurfaceMap& map,
                        const ParameterValues& parameters);

}  // namespace pellucid
