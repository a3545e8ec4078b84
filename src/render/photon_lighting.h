#pragma once

#include "techniques/photons/photons.h"

#include <pellucid/scene.h>

#include <cstdint>

namespace pellucid {

/// What is to send photons.
struct PhotonSources {
    bool lights = false;
    bool emitters = false;                           ///< the scene's emissive surfaces
    const EnvironmentShares* environment = nullptr;  ///< null: the environment sends none
};

/// Views of every light of the scene that hold what bends its light: refracting objects, and metal that mirrors; and the
/// other sources. `count`: photons per light and frame, at most; emissive surfaces together count as one light, and so does
/// the environment. PhotonSetup::any() is false if nothing is bent.
PhotonSetup photon_setup(const Scene& scene, const Bounds& bounds, const PhotonSources& sources, std::uint32_t count);

/// Irradiance that is usual in the scene, W/m2: of its environment, its lights and what emits.
float scene_brightness(const Scene& scene, const Bounds& bounds, const gpu::FrameConstants& environment);

}  // namespace pellucid
