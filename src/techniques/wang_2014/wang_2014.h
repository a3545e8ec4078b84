#pragma once

#include "techniques/technique.h"

namespace pellucid {

/// Four-layer image-space refraction: Wang, "Image Space Real-time Multi-refraction Technology",
/// master's thesis, National Chengchi University, 2014.
extern const Technique kWang2014;

}  // namespace pellucid
