#pragma once

// Photons through a ball of glass, counted on a plane and in voxels behind it: the reference for caustics of volumes.
// It shares no code with the tracing of wavefronts.

#include <glm/glm.hpp>

#include <vector>

namespace pellucid {

/// Parallel light on a ball around the origin, inside a box, over a level plane.
struct BallAndPlane {
    double radius = 1.0;  ///< radius of the ball, m
    double ior = 1.5;
    double smoothing = 0.0;         ///< standard deviation of the Gaussian that smooths its surface, m; 0: Snell's law
    double box = 1.0625;            ///< half the edge of the cube, m; light that misses the cube is not counted
    glm::dvec3 direction{0.0};      ///< unit, direction of travel of the light
    glm::dvec3 corner{0.0};         ///< corner of the plane's map, world
    glm::dvec3 side{0.0}, up{0.0};  ///< unit, perpendicular to each other
    double texel = 1.0;             ///< edge of a texel, m
    int width = 0, height = 0;      ///< texels
};

/// A cube of voxels around the ball, of size BallAndPlane::box.
struct VoxelPhotons {
    int resolution = 0;           ///< voxels along an edge
    std::vector<double> fluence;  ///< fluence rate of every voxel for light of irradiance 1, x fastest
    std::vector<double> photons;  ///< number of photons that passed each voxel
};

/// Counts photons by path length in voxels, for light that has left or missed the ball; 0 inside the ball.
/// `per_voxel`: photons along the edge of a voxel.
VoxelPhotons count_voxel_photons(const BallAndPlane& scene, int resolution, int per_voxel);

/// Irradiance of every texel for light of irradiance 1. `photons`: number of rings of photons around the ball's axis,
/// with evenly spaced photons in each ring. No light is reflected or absorbed.
std::vector<double> count_photons(const BallAndPlane& scene, int photons);

/// Spot in which a map's light concentrates.
struct CausticSpot {
    glm::dvec2 center{0.0};  ///< centroid of the power within `reach`, texels
    double radius = 0.0;     ///< radius of the circle around `center` with half of that power, texels
};
CausticSpot caustic_spot(const std::vector<double>& map, int width, glm::dvec2 around, double reach);

/// Pearson's correlation of two maps of equal size.
double correlation(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace pellucid
