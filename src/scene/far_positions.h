#pragma once

#include "scene/warnings.h"

#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <limits>
#include <span>
#include <string>

namespace pellucid {

/// Axis-aligned box in double precision, initially empty.
struct Box {
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-std::numeric_limits<double>::infinity()};

    void add(const glm::dvec3& position) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    /// Adds the transformed corners of `box`.
    void add(const Box& box, const glm::dmat4& transform);
    bool empty() const { return !(low.x <= high.x); }
    double extent() const;  ///< the longest side
};
Box box_of(std::span<const glm::vec3> positions);

/// Origin of a frame in which content with this box keeps its 32-bit precision. A component is 0 if the box's centre
/// lies within 8 radii of 0 along that axis. Otherwise it is the centre, rounded to a multiple of a power of two near
/// the radius. Such an origin is short to write, and subtracts exactly from 32-bit positions in the box.
glm::dvec3 frame_origin(const Box& box);

/// Subtracts the frame_origin() of the mesh's box from its positions, exactly. Returns that origin.
glm::dvec3 recentre(Mesh& mesh);

/// Finds the mesh whose 32-bit positions are the coarsest relative to its size. Small parts of a scene about its
/// origin are ignored: the spacing must exceed 1e-6 of the mesh's extent and 1e-7 of the scene's.
class CoarsePositions {
public:
    explicit CoarsePositions(double scene_extent) : smallest_spacing_(1e-7 * scene_extent) {}  ///< m

    /// `box`: box of the mesh in file units; `scale`: metres per file unit.
    void add(const std::string& mesh, const Box& box, double scale);
    /// Adds a warning that names the coarsest mesh, if any.
    void warn(Warnings& warnings) const;

private:
    double smallest_spacing_;
    std::string mesh_;
    double ratio_ = 1e-6;                    ///< spacing / extent
    double distance_ = 0.0, spacing_ = 0.0;  ///< m
};

}  // namespace pellucid
