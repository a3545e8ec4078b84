#pragma once

#include <pellucid/api.h>

#include <glm/glm.hpp>

#include <cstdint>
#include <string_view>

namespace pellucid {

/// Why a pixel's refraction may be wrong. The numbers are those of the `status` AOV.
enum class Status : std::uint32_t {
    kOk = 0,            ///< every interface on the path was found (or there is no glass here)
    kMissingLayer = 1,  ///< an interface lies in no layer that the technique looks at
    kLeftScreen = 2,    ///< the path went where no layer was recorded: outside the picture
    kStepLimit = 3,     ///< the search used up its steps
    kEventLimit = 4,    ///< more interface events than the technique follows
};
inline constexpr std::uint32_t kStatusCount = 5;
/// The name of a status, "missing_layer".
PELLUCID_API std::string_view status_name(Status status);

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
