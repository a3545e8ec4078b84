#pragma once

#include "lab/experiments.h"

namespace pellucid::cli {

/// Ihrke et al. 2007: light traced through volumes. Compares a ball's caustic with counted photons; measures a wine
/// glass's voxels, and times.
ExperimentSpec ihrke_light();
/// Compares wavefronts with photons, and measures the cost of reflected light.
ExperimentSpec ihrke_reflections();

}  // namespace pellucid::cli
