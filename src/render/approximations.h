#pragma once

#include "gpu/scene_topology.h"
#include "render/frame.h"

#include <pellucid/renderer.h>
#include <pellucid/scene.h>
#include <pellucid/technique.h>

#include <string>
#include <vector>

namespace pellucid {

/// True for visible lights: directional lights with an angular diameter, point and spot lights with a radius.
bool has_size(const Light& light);

/// Approximations of `scene` by the technique: one line each, for the user. `photons`: the technique sends photons.
std::vector<std::string> approximations(const Scene& scene, const TechniqueInfo& technique, const LightOptions& light,
                                        bool photons);

/// Approximations of solids, by techniques that do not track the solids around a ray.
std::vector<std::string> unknown_solids(const SceneTopology& topology, const TechniqueInfo& technique);

/// Adds warnings about possible errors in an image, by its counts. `cut`: the image was drawn in tiles, and several
/// contain glass.
void warn_of(RenderResult& result, const FrameSettings& chosen, bool cut, const RenderSettings& settings);

}  // namespace pellucid
