#pragma once

#include "techniques/photons/photons.h"

#include <pellucid/scene.h>

#include <cstdint>

namespace pellucid {

/// Sources of photons.
struct PhotonSources {
    bool lights = false;
    bool emitters = false;                           ///< the scene's emissive surfaces
    const EnvironmentShares* environment = nullptr;  ///< null: the environment sends no photons
};

/// Views of every light that contain everything that bends its light: refracting objects and metal mirrors; and the
/// other sources. `count`: most photons per light and frame. All emissive surfaces together count as one light, and so
/// does the environment. PhotonSetup::any() is false if nothing bends light.
PhotonSetup photon_setup(const Scene& scene, const Bounds& bounds, const PhotonSources& sources, std::uint32_t count);

/// Typical irradiance in the scene, W/m2, from its environment, lights and emissive surfaces.
float scene_brightness(const Scene& scene, const Bounds& bounds, const gpu::FrameConstants& environment);

}  // namespace pellucid
