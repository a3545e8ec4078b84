#pragma once

#include "scene/warnings.h"

#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <limits>
#include <span>
#include <string>

namespace pellucid {

/// Axis-aligned box in double precision; empty at first.
struct Box {
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-std::numeric_limits<double>::infinity()};

    void add(const glm::dvec3& position) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    /// Adds the corners of `box`, transformed.
    void add(const Box& box, const glm::dmat4& transform);
    bool empty() const { return !(low.x <= high.x); }
    double extent() const;  ///< the longest side
};
Box box_of(std::span<const glm::vec3> positions);

/// Origin of the frame in which content with this box keeps its 32-bit precision. A component is 0 where the box's
/// centre lies within 8 radii of 0 along that axis. Otherwise it is the centre, rounded to a multiple of a power of
/// two near the radius: short to write, and subtracted without error from 32-bit numbers of the box.
glm::dvec3 frame_origin(const Box& box);

/// Subtracts the frame_origin() of the mesh's box from its positions, and returns it. Exact.
glm::dvec3 recentre(Mesh& mesh);

/// Finds the mesh whose 32-bit positions are the coarsest for its size. A small part of a scene about its origin does
/// not count: floats must be spaced by more than 1e-6 of the mesh's extent and by more than 1e-7 of the scene's.
class CoarsePositions {
public:
    explicit CoarsePositions(double scene_extent) : smallest_spacing_(1e-7 * scene_extent) {}  ///< m

    /// `box`: the mesh's, as stored in the file; `scale`: metres per unit of it.
    void add(const std::string& mesh, const Box& box, double scale);
    /// Names that mesh, if there is one.
    void warn(Warnings& warnings) const;

private:
    double smallest_spacing_;
    std::string mesh_;
    double ratio_ = 1e-6;                    ///< spacing by extent
    double distance_ = 0.0, spacing_ = 0.0;  ///< m
};

}  // namespace pellucid
