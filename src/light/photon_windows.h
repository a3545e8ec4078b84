#pragma once

#include "gpu/punctual_light.h"
#include "light/light_views.h"

namespace pellucid {

/// Part of a light's view through which it sends photons, or all that emissive surfaces or the environment send; twin in photon_windows.glsl.
struct PhotonWindow {
    enum class Source : std::uint32_t { kLights, kEmitters, kEnvironment };
    glm::mat4 world_from_view;
    glm::vec4 film;       ///< as FrameConstants::film
    PunctualLight light;  ///< kEmitters, kEnvironment: position and radius of the sphere around all targets
    std::uint32_t orthographic;
    float target_depth;  ///< m, of the middle of what is aimed at; kEnvironment: from there to beyond the scene
    Source source;
    std::uint32_t reserved;
};
static_assert(sizeof(PhotonWindow) == 160);

}  // namespace pellucid
