#pragma once

#include "reference/geometry.h"
#include "reference/random.h"

#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <optional>
#include <span>
#include <vector>

namespace pellucid::reference {

/// Light of a point, spot or directional light, in one direction from where it arrives, if nothing is in between.
struct ArrivingLight {
    glm::dvec3 direction{0.0};   ///< unit, towards the light
    double distance = 0.0;       ///< m, to its surface; infinite for a directional light
    glm::dvec3 irradiance{0.0};  ///< W/m2 on a surface that faces it: radiance over `pdf` if the light has a size
    double pdf = 0.0;            ///< density of the direction, per steradian; 0: no path meets the light by chance
};

/// As if the light had no size. KHR_lights_punctual (Khronos Group, glTF 2.0 extension), sections "Inner and Outer Cone
/// Angles" and "Range Property", with their recommended falloffs. Nothing where no light arrives.
std::optional<ArrivingLight> arriving_from_center(const Light& light, const glm::dvec3& position);

/// From a direction that is uniform in the solid angle under which the light is seen from `position`. `random` is not used
/// for lights without a size. Nothing where no light arrives.
std::optional<ArrivingLight> arriving_light(const Light& light, const glm::dvec3& position, Random& random);

/// Density with which arriving_light() chooses a direction that meets the light from `position`, per steradian.
double arriving_pdf(const Light& light, const glm::dvec3& position);

/// Radiance of a light with a size that is seen along the unit vector `direction`, before the falloff by its range: of a
/// directional light its irradiance over the solid angle of its disc, of a lamp its intensity over the area of its disc.
glm::dvec3 radiance_of(const Light& light, const glm::dvec3& direction);

bool has_size(const Light& light);

/// A unit vector around the z axis, uniform in solid angle in a cone with that 1 - cos of its half angle.
glm::dvec3 uniform_in_cone(double one_less_cosine, const glm::dvec2& u);
/// 1 - cos of half the angle that a directional light subtends.
double one_less_cosine(const Light& light);

/// Share of a spot's intensity in a direction whose cosine to its axis is `cos_angle`: the square of a ramp in the
/// cosine from the outer to the inner angle.
double cone_share(const Light& light, double cos_angle);

/// Share that is left after `distance`, m: fades the light out towards its range, so that it has no edge there.
double range_share(const Light& light, double distance);

/// Lights that rays can meet. Lamps and spots are opaque black balls that shine, there for rays from outside alone;
/// suns are discs behind everything.
class SizedLights {
public:
    /// The lights must outlive this.
    explicit SizedLights(std::span<const Light> lights);

    /// The nearest ball that the ray meets before `query.t_max`, and its distance, m. `but`: a light whose ball is left out.
    struct Ball {
        const Light* light = nullptr;
        double t = 0.0;
    };
    Ball nearest(const Query& query, const Light* but = nullptr) const;
    /// The nearest surface or ball. `ball`: its light, or null; of such a hit t and position alone are set.
    Hit intersect(const Geometry& geometry, const Query& query, const Light*& ball) const;

    /// Directional lights whose disc a ray in that direction meets.
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
