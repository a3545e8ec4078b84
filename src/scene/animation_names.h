#pragma once

#include "scene/rig.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// Index of the animation with this name, or else with this number. Throws Error that begins with `source` and lists
/// the known animations.
std::size_t find_animation(const std::vector<Animation>& animations, std::string_view name, const std::string& source);

/// Throws Error unless the time is finite and not negative.
void check_animation_time(double time_s);

}  // namespace pellucid
