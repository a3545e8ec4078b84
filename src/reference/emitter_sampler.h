#pragma once

#include "reference/geometry.h"
#include "reference/random.h"

#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace pellucid::reference {

/// Samples points on emissive surfaces: a triangle in proportion to its area times its mean emission, texture
/// included, then a uniform point on it (Shirley, Wang & Zimmerman, "Monte Carlo techniques for direct lighting
/// calculations", 1996, section 3.2.2).
///
/// It samples opaque surfaces and panes. Boundaries of solids and unlit surfaces have density 0. A triangle also has
/// density 0 if its texture is black at all points of the mean. Combine with BSDF sampling.
class EmitterSampler {
public:
    /// `geometry` must outlive the sampler. Build a new sampler when triangles move.
    EmitterSampler(const Geometry& geometry, const Scene& scene);

    /// True if nothing emits; then do not call sample().
    bool dark() const { return triangles_.empty(); }

    struct Sample {
        std::uint32_t object = 0;    ///< index into Scene::objects
        std::uint32_t triangle = 0;  ///< index into Mesh::triangles
        glm::dvec3 direction{0.0};   ///< unit, from the receiver towards the point
        double distance = 0.0;       ///< m
        double pdf = 0.0;            ///< of the direction, per steradian, > 0
    };
    /// Empty if the sampled surface does not face `from`.
    std::optional<Sample> sample(const glm::dvec3& from, Random& random) const;

    /// Density of sample() for the direction from `from` to the point `hit`, per steradian.
    double pdf(const glm::dvec3& from, const Hit& hit) const;

private:
    static constexpr std::size_t kNone = ~std::size_t(0);
    struct Triangle {
        std::uint32_t object, triangle;
        double share_up_to;  ///< cumulative probability, 0..1, up to and including this triangle
        double density;      ///< density of points, 1/m2
    };
    void add(const Scene& scene, std::uint32_t object);

    const Geometry& geometry_;
    std::vector<Triangle> triangles_;
    std::vector<std::size_t> first_;  ///< per object: index of its first triangle, or kNone
};

}  // namespace pellucid::reference
