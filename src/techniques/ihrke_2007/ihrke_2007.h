#pragma once

#include "techniques/technique.h"

namespace pellucid {

/// Ihrke et al. 2007: curved view rays through volumes of varying index. See README.md.
extern const Technique kIhrke2007;

}  // namespace pellucid
