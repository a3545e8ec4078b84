#pragma once

#include <pellucid/scene.h>

#include <string>
#include <vector>

namespace pellucid {

/// What of `scene` the renderer draws otherwise than it is: one line each, for the user.
std::vector<std::string> approximations(const Scene& scene);

}  // namespace pellucid
