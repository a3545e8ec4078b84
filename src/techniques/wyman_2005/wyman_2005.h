#pragma once

#include "techniques/technique.h"

namespace pellucid {

/// Refraction at two interfaces: the far one is guessed from baked distances.
extern const Technique kWyman2005;

}  // namespace pellucid
