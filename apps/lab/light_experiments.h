#pragma once

#include "lab/experiments.h"

namespace pellucid::cli {

/// Ihrke et al. 2007: light traced through volumes; a ball's caustic against counted photons, a wine glass's voxels, time.
ExperimentSpec ihrke_light();
/// Wavefronts against photons, and what following reflected light costs.
ExperimentSpec ihrke_reflections();

}  // namespace pellucid::cli
