#pragma once

#include "techniques/photons/photons.h"

#include <pellucid/scene.h>

#include <cstdint>

namespace pellucid {

/// Views of every light of the scene that hold what bends its light: refracting objects, and metal that mirrors. `count`:
/// photons per light and frame, at most. No views: nothing is bent.
PhotonSetup photon_setup(const Scene& scene, const Bounds& bounds, std::uint32_t count);

/// Irradiance that is usual in the scene, W/m2: of its environment, its lights and what emits.
float scene_brightness(const Scene& scene, const Bounds& bounds, const gpu::FrameConstants& environment);

}  // namespace pellucid
