#pragma once

#include <pellucid/technique.h>

#include <glm/glm.hpp>

#include <cstdint>

namespace pellucid {

/// Where the light path through one pixel comes from: the view ray, refracted at every interface of
/// glass, reflected where it is totally reflected. The common measure of all techniques.
struct RefractedPath {
    glm::vec3 direction{0.0f};      ///< unit, world; away from the eye, as it leaves the last interface
    glm::vec3 position{0.0f};       ///< world, m: the last interface; the surface hit if the path ends on an opaque one
    glm::vec3 transmittance{1.0f};  ///< Fresnel transmittance and absorption along the path, 0..1
    float length_inside = 0.0f;     ///< m, inside media
    float length = 0.0f;            ///< m, from the eye to `position`; 0 where a technique does not keep it
    std::int32_t object = -1;       ///< index of the opaque object that the path ends on; -1: the environment
    std::uint16_t events = 0;       ///< refractions and reflections; 0: the first surface is no refracting glass
    std::uint16_t reflections = 0;  ///< total internal reflections among them
    Status status = Status::kOk;
    bool side_conflict = false;  ///< somewhere the shading normal faced the other side than the surface
};

}  // namespace pellucid
