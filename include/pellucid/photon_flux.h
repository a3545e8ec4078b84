#pragma once

#include <glm/glm.hpp>

#include <vector>

namespace pellucid {

/// Where the light goes that lights, emissive surfaces and the environment send towards glass and metal in one frame: W, RGB, before any kernel. What is sent and
/// arrives nowhere was absorbed, or followed no further.
struct PhotonFlux {
    /// What an opaque object gets.
    struct Received {
        glm::dvec3 bent{0.0};      ///< by photons: glass has bent it, or metal reflected it
        glm::dvec3 straight{0.0};  ///< straight from the light, or through thin walls: what shadow rays bring
    };
    glm::dvec3 sent{0.0};
    glm::dvec3 left{0.0};           ///< without meeting another opaque surface
    std::vector<Received> objects;  ///< one per Scene::objects; empty: no photons were sent
};

}  // namespace pellucid
