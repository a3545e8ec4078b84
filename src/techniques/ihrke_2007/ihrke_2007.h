#pragma once

#include "techniques/technique.h"

namespace pellucid {

/// Curved view rays through volumes of varying index (Ihrke et al. 2007). See README.md.
extern const Technique kIhrke2007;

}  // namespace pellucid
