#pragma once

#include "experiments.h"

namespace pellucid::cli {

/// Ihrke et al. 2007: light traced through volumes; a ball's caustic against counted photons, a wine glass's voxels, time.
ExperimentSpec ihrke_light();

}  // namespace pellucid::cli
