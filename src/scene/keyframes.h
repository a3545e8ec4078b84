#pragma once

#include "scene/rig.h"

#include <vector>

namespace pellucid {

/// Values at a time (s), interpolated component by component.
std::vector<double> value_at(const Keyframes& keyframes, double time_s);

/// The unit quaternion at a time; keyframes have width 4 (x, y, z, w) and no zero among their values. LINEAR is
/// the spherical interpolation along the shorter arc.
glm::dquat rotation_at(const Keyframes& keyframes, double time_s);

}  // namespace pellucid
