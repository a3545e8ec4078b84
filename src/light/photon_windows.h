#pragma once

#include "gpu/punctual_light.h"
#include "light/light_views.h"

namespace pellucid {

/// Part of a light's view through which it sends photons; twin in photon_windows.glsl.
struct PhotonWindow {
    glm::mat4 world_from_view;
    glm::vec4 film;  ///< as FrameConstants::film
    PunctualLight light;
    std::uint32_t orthographic;
    float target_depth;  ///< m, of the middle of what is aimed at
    std::uint32_t reserved[2];
};
static_assert(sizeof(PhotonWindow) == 160);

}  // namespace pellucid
