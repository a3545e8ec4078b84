#pragma once

#include "reference/geometry.h"
#include "reference/random.h"

#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <optional>
#include <span>
#include <vector>

namespace pellucid::reference {

/// Unoccluded light from one direction of a point, spot or directional light.
struct ArrivingLight {
    glm::dvec3 direction{0.0};   ///< unit, towards the light
    double distance = 0.0;       ///< m, to the light's surface; infinite for a directional light
    glm::dvec3 irradiance{0.0};  ///< W/m2 on a surface that faces the light: radiance over `pdf` for a sized light
    double pdf = 0.0;  ///< density of the direction, per steradian; 0: the light has no size, and paths cannot hit it
};

/// Light from the light's centre, as if it had no size. The falloffs are those recommended by KHR_lights_punctual
/// (Khronos Group, glTF 2.0 extension), sections "Inner and Outer Cone Angles" and "Range Property". Empty where no
/// light arrives.
std::optional<ArrivingLight> arriving_from_center(const Light& light, const glm::dvec3& position);

/// Light from a direction uniform in the solid angle that the light subtends at `position`. Lights without a size do
/// not use `random`. Empty where no light arrives.
std::optional<ArrivingLight> arriving_light(const Light& light, const glm::dvec3& position, Random& random);

/// Density of arriving_light() for a direction from `position` that hits the light, per steradian.
double arriving_pdf(const Light& light, const glm::dvec3& position);

/// Radiance of a sized light seen along the unit vector `direction`, before its falloff by range. Directional light:
/// irradiance over the solid angle of its disc. Lamp: intensity over the area of its disc.
glm::dvec3 radiance_of(const Light& light, const glm::dvec3& direction);

bool has_size(const Light& light);

/// Unit vector around the z axis, uniform in solid angle in a cone. `one_less_cosine`: 1 - cos of its half angle.
glm::dvec3 uniform_in_cone(double one_less_cosine, const glm::dvec2& u);
/// 1 - cos of half the angle that a directional light subtends.
double one_less_cosine(const Light& light);

/// Share of a spot's intensity at cosine `cos_angle` to its axis: square of a linear ramp in the cosine, from the
/// outer to the inner angle.
double cone_share(const Light& light, double cos_angle);

/// Falloff after `distance`, m: fades the light to 0 at its range, without an edge.
double range_share(const Light& light, double distance);

/// Lights that rays can hit. Lamps and spots are opaque black emissive balls, visible from outside only. Directional
/// lights are discs behind everything.
class SizedLights {
public:
    /// The lights must outlive this.
    explicit SizedLights(std::span<const Light> lights);

    /// The nearest ball that the ray hits before `query.t_max`, and its distance, m. `but`: a light to ignore.
    struct Ball {
        const Light* light = nullptr;
        double t = 0.0;
    };
    Ball nearest(const Query& query, const Light* but = nullptr) const;
    /// The nearest surface or ball. `ball`: its light, or null. For a ball the hit has only t and position.
    Hit intersect(const Geometry& geometry, const Query& query, const Light*& ball) const;

    /// Visits directional lights whose disc a ray in `direction` hits.
    template <class Visit>
    void for_each_sun(const glm::dvec3& direction, const Visit& visit) const {
        for (const Light* sun : suns_) {
            if (shows(*sun, direction)) visit(*sun);
        }
    }

private:
    static bool shows(const Light& sun, const glm::dvec3& direction);

    std::vector<const Light*> balls_, suns_;
};

}  // namespace pellucid::reference
