#pragma once

#include "techniques/technique.h"

namespace pellucid {

/// Refraction at two interfaces, the second found by a search in the depths of the back faces: Oliveira & Brauwers,
/// "Real-Time Refraction Through Deformable Objects", I3D 2007.
extern const Technique kOliveiraBrauwers2007;

}  // namespace pellucid
