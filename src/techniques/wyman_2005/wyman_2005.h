#pragma once

#include "techniques/technique.h"

namespace pellucid {

/// Refraction at two interfaces; the second is estimated from baked distances.
extern const Technique kWyman2005;

}  // namespace pellucid
