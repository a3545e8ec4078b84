#pragma once

#include <pellucid/scene.h>
#include <pellucid/technique.h>

#include <string>
#include <vector>

namespace pellucid {

/// What of `scene` the technique draws otherwise than it is: one line each, for the user.
std::vector<std::string> approximations(const Scene& scene, const TechniqueInfo& technique);

}  // namespace pellucid
