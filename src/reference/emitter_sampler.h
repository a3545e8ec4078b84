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

/// Chooses points of emissive surfaces: a triangle by its area times its mean emission, texture included, and a uniform point
/// of it (Shirley, Wang & Zimmerman, "Monte Carlo techniques for direct lighting calculations", 1996, section 3.2.2).
///
/// Opaque surfaces and panes are chosen; boundaries of solids and unlit surfaces are not, and have density 0.
/// So has a triangle whose texture is black wherever its mean looked: combine with directions chosen by the surface.
class EmitterSampler {
public:
    /// `geometry` must outlive the sampler; triangles that move need a new one.
    EmitterSampler(const Geometry& geometry, const Scene& scene);

    /// True if nothing can be chosen: sample() must not be called.
    bool dark() const { return triangles_.empty(); }

    struct Sample {
        std::uint32_t object = 0;    ///< Scene::objects
        std::uint32_t triangle = 0;  ///< Mesh::triangles
        glm::dvec3 direction{0.0};   ///< unit, from the receiver towards the point
        double distance = 0.0;       ///< m
        double pdf = 0.0;            ///< of the direction, per steradian, > 0
    };
    /// Nothing where the point's surface does not face `from`.
    std::optional<Sample> sample(const glm::dvec3& from, Random& random) const;

    /// Density with which sample() chooses the direction from `from` to the point `hit`, per steradian.
    double pdf(const glm::dvec3& from, const Hit& hit) const;

private:
    static constexpr std::size_t kNone = ~std::size_t(0);
    struct Triangle {
        std::uint32_t object, triangle;
        double share_up_to;  ///< probability, 0..1, of this triangle and those before it
        double density;      ///< of points, 1/m2
    };
    void add(const Scene& scene, std::uint32_t object);

    const Geometry& geometry_;
    std::vector<Triangle> triangles_;
    std::vector<std::size_t> first_;  ///< per object: index of its first triangle, or kNone
};

}  // namespace pellucid::reference
