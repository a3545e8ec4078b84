#pragma once

#include "lab/experiments.h"

namespace pellucid::cli {

/// Kay and Greenberg 1979, figures 1, 2 and 10 to 12: transparency of their surfaces against exact paths.
ExperimentSpec kay_greenberg_transparency();
/// The same, section 4.3: position on the background against exact paths.
ExperimentSpec kay_greenberg_background();

}  // namespace pellucid::cli
