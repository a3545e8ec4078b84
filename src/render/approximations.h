#pragma once

#include "gpu/scene_topology.h"
#include "render/frame.h"

#include <pellucid/renderer.h>
#include <pellucid/scene.h>
#include <pellucid/technique.h>

#include <string>
#include <vector>

namespace pellucid {

/// Whether a light is seen itself: a sun with an angular diameter, a lamp or spot with a radius.
bool has_size(const Light& light);

/// What of `scene` the technique draws otherwise than it is: one line each, for the user. `photons`: it sends some.
std::vector<std::string> approximations(const Scene& scene, const TechniqueInfo& technique, const LightOptions& light,
                                        bool photons);

/// The same of solids, for techniques that do not count what a ray is inside of.
std::vector<std::string> unknown_solids(const SceneTopology& topology, const TechniqueInfo& technique);

/// Adds what may be wrong in a picture, by its counts, to its warnings. `cut`: it was drawn in tiles and glass lies in
/// several.
void warn_of(RenderResult& result, const FrameSettings& chosen, bool cut, const RenderSettings& settings);

}  // namespace pellucid
