#pragma once

#include <glm/glm.hpp>

#include <vector>

namespace pellucid {

/// Destinations of the light that lights, emissive surfaces and the environment emit towards glass and metal in one
/// frame. W, RGB, before any kernel. Flux that is sent and arrives nowhere was absorbed or no longer followed.
struct PhotonFlux {
    /// Flux received by an opaque object.
    struct Received {
        glm::dvec3 bent{0.0};      ///< through photons: refracted by glass or reflected by metal
        glm::dvec3 straight{0.0};  ///< along straight rays from the light, thin walls included, as shadow rays find it
    };
    glm::dvec3 sent{0.0};
    glm::dvec3 left{0.0};           ///< left the scene without meeting another opaque surface
    std::vector<Received> objects;  ///< one per Scene::objects; empty: no photons were sent
};

}  // namespace pellucid
