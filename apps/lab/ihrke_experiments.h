#pragma once

#include "lab/experiments.h"

namespace pellucid::cli {

/// Ihrke et al. 2007, section 4.1: view rays through a smoothed ball against refraction at the surface of a ball.
ExperimentSpec ihrke_rays();

}  // namespace pellucid::cli
