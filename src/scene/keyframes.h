#pragma once

#include "scene/rig.h"

#include <vector>

namespace pellucid {

/// Values at a time, s, interpolated per component.
std::vector<double> value_at(const Keyframes& keyframes, double time_s);

/// Unit quaternion at a time, s. Keyframes must have width 4 (x, y, z, w) and non-zero values. LINEAR means spherical
/// interpolation along the shorter arc.
glm::dquat rotation_at(const Keyframes& keyframes, double time_s);

}  // namespace pellucid
