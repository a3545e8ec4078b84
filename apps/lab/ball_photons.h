#pragma once

// Photons through a ball of glass, counted where they land on a plane and in voxels behind it: the truth for caustics of
// volumes. Shares no code with the tracing of wavefronts.

#include <glm/glm.hpp>

#include <vector>

namespace pellucid {

/// Parallel light on a ball around the origin, in a box around it, over a level plane.
struct BallAndPlane {
    double radius = 1.0;  ///< of the ball, m
    double ior = 1.5;
    double smoothing = 0.0;         ///< standard deviation of the Gaussian that smooths its surface, m; 0: Snell's law
    double box = 1.0625;            ///< half the edge of the cube, m: light that misses it is not counted
    glm::dvec3 direction{0.0};      ///< unit; the way of the light
    glm::dvec3 corner{0.0};         ///< of the plane's map, world
    glm::dvec3 side{0.0}, up{0.0};  ///< unit, square to each other
    double texel = 1.0;             ///< edge of a texel, m
    int width = 0, height = 0;      ///< texels
};

/// A cube of voxels around the ball, as `box` says.
struct VoxelPhotons {
    int resolution = 0;           ///< voxels along an edge
    std::vector<double> fluence;  ///< fluence rate of every voxel for a light of irradiance 1, x fastest
    std::vector<double> photons;  ///< that have passed it
};

/// As count_photons(), by the length of way in voxels: of light that has left the ball, or has passed it by; nothing inside
/// the ball. `per_voxel`: photons along the edge of a voxel.
VoxelPhotons count_voxel_photons(const BallAndPlane& scene, int resolution, int per_voxel);

/// Irradiance of every texel for a light of irradiance 1, from `photons` rings of photons around the ball's axis, as many in
/// each as keeps them evenly apart. Nothing is reflected or absorbed.
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
