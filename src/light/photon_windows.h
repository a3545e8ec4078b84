#pragma once

#include "gpu/punctual_light.h"
#include "light/light_views.h"

namespace pellucid {

/// A part of a light's view through which it emits photons, or the photons of emissive surfaces or the environment.
/// Twin of PhotonWindow in photon_windows.glsl.
struct PhotonWindow {
    enum class Source : std::uint32_t { kLights, kEmitters, kEnvironment };
    glm::mat4 world_from_view;
    glm::vec4 film;       ///< see FrameConstants::film
    PunctualLight light;  ///< kEmitters, kEnvironment: position and radius of the sphere around all targets
    std::uint32_t orthographic;
    float target_depth;  ///< depth of the targets' centre, m; kEnvironment: distance from there to beyond the scene
    Source source;
    std::uint32_t reserved;
};
static_assert(sizeof(PhotonWindow) == 160);

}  // namespace pellucid
