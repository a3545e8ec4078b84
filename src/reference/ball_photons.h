#pragma once

// Photons through a ball of glass by Snell's law alone, counted where they land on a plane: the truth for caustics of
// volumes. Shares no code with the tracing of wavefronts.

#include "core/math.h"

#include <vector>

namespace pellucid {

/// Parallel light on a ball around the origin, in a box around it, over a level plane.
struct BallAndPlane {
    double radius = 1.0;  ///< of the ball, m
    double ior = 1.5;
    double box = 1.0625;        ///< half the edge of the cube, m: light that misses it is not counted
    glm::dvec3 direction;       ///< unit; the way of the light
    glm::dvec3 corner;          ///< of the plane's map, world
    glm::dvec3 side, up;        ///< unit, square to each other
    double texel = 1.0;         ///< edge of a texel, m
    int width = 0, height = 0;  ///< texels
};

/// Irradiance of every texel for a light of irradiance 1, from `photons` x `photons` on a square grid across the way of
/// the light. Nothing is reflected or absorbed.
std::vector<double> count_photons(const BallAndPlane& scene, int photons);

/// Where the light of a map is gathered.
struct CausticSpot {
    glm::dvec2 center{0.0};  ///< of the power within `reach`, texels
    double radius = 0.0;     ///< of the circle around that with half of it, texels
};
CausticSpot caustic_spot(const std::vector<double>& map, int width, glm::dvec2 around, double reach);

/// Pearson's correlation of two maps of one size.
double correlation(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace pellucid
