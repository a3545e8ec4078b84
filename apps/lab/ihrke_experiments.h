#pragma once

#include "lab/experiments.h"

namespace pellucid::cli {

/// Ihrke et al. 2007, section 4.1: view rays through a smoothed ball, compared with refraction at a sharp ball.
ExperimentSpec ihrke_rays();

}  // namespace pellucid::cli
