#pragma once

#include "scene/rig.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// Index of the animation of a name, else of a number. Throws Error that begins with `source` and lists those that
/// there are.
std::size_t find_animation(const std::vector<Animation>& animations, std::string_view name, const std::string& source);

/// Throws Error unless a time is finite and not negative.
void check_animation_time(double time_s);

}  // namespace pellucid
