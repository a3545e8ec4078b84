#pragma once

#include "techniques/technique.h"

namespace pellucid {

/// Refraction at the first interface only, then the environment.
extern const Technique kOneInterface;

}  // namespace pellucid
