#pragma once

#include "techniques/technique.h"

namespace pellucid {

/// Surfaces over a background image: Kay & Greenberg, "Transparency for Computer Synthesized Images",
/// SIGGRAPH 1979.
extern const Technique kKayGreenberg1979;

}  // namespace pellucid
