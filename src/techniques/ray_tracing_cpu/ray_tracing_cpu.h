#pragma once

#include "techniques/technique.h"

namespace pellucid {

extern const Technique kRayTracingCpu;

}  // namespace pellucid
