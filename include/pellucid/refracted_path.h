#pragma once

#include <pellucid/api.h>

#include <glm/glm.hpp>

#include <cstdint>
#include <string_view>

namespace pellucid {

/// Reason why a pixel's refraction may be wrong. The `status` AOV contains these numbers.
enum class Status : std::uint32_t {
    kOk = 0,            ///< every interface on the path was found, or the pixel shows no glass
    kMissingLayer = 1,  ///< an interface lies in none of the technique's layers
    kLeftScreen = 2,    ///< the path left the image, where no layer was recorded
    kStepLimit = 3,     ///< the search reached its limit of steps
    kEventLimit = 4,    ///< the path has more interface events than the technique follows
};
inline constexpr std::uint32_t kStatusCount = 5;
/// The name of a status, "missing_layer".
PELLUCID_API std::string_view status_name(Status status);

/// The view path through one pixel, refracted at every interface of glass and reflected at total internal reflection.
/// All techniques are compared by it.
struct RefractedPath {
    glm::vec3 direction{0.0f};      ///< unit, world; away from the eye, after the last interface
    glm::vec3 position{0.0f};       ///< world, m: the last interface, or the hit if the path ends on an opaque object
    glm::vec3 transmittance{1.0f};  ///< Fresnel transmittance and absorption along the path, 0..1
    float length_inside = 0.0f;     ///< m, inside media
    float length = 0.0f;            ///< m, from the eye to `position`; 0 if the technique does not record it
    std::int32_t object = -1;       ///< index of the opaque object that the path ends on; -1: the environment
    std::uint16_t events = 0;       ///< refractions and reflections; 0: the first surface is not refracting glass
    std::uint16_t reflections = 0;  ///< total internal reflections among the events
    Status status = Status::kOk;
    /// at some interface the shading normal and the geometric normal disagreed about the side
    bool side_conflict = false;
};

}  // namespace pellucid
