#pragma once

#include "gpu/scene_topology.h"

#include <pellucid/renderer.h>
#include <pellucid/scene.h>
#include <pellucid/technique.h>

#include <optional>
#include <string>
#include <vector>

namespace pellucid {

/// What of `scene` the technique draws otherwise than it is: one line each, for the user.
std::vector<std::string> approximations(const Scene& scene, const TechniqueInfo& technique);

/// The same of solids, for techniques that do not count what a ray is inside of.
std::vector<std::string> unknown_solids(const SceneTopology& topology, const TechniqueInfo& technique);

/// One line where more than 1% of the glass pixels have a status other than ok: how many, and of which status.
std::optional<std::string> bad_status_warning(const RenderResult& result, const TechniqueInfo& technique);

}  // namespace pellucid
