#pragma once

#include "techniques/technique.h"

namespace pellucid {

extern const Technique kRayTracing;

}  // namespace pellucid
