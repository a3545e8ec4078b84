#pragma once

#include "reference/random.h"

#include <pellucid/environment.h>

#include <glm/glm.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace pellucid::reference {

/// Samples directions approximately in proportion to the incident light: by the mean luminance of the cells of an
/// equirectangular grid, uniform in solid angle within a cell. Apart from that it follows Pharr, Jakob & Humphreys,
/// Physically Based Rendering, 4th ed., 2023, section 12.5. A map has one cell per texel; formulas are tabulated.
///
/// pdf() is 0 in cells whose share of the light is too small for a float, though radiance may not be. Combine with
/// BSDF sampling (multiple importance sampling).
class EnvironmentSampler {
public:
    /// `environment` must be checked.
    explicit EnvironmentSampler(const Environment& environment);

    /// True if the environment is black; then do not call sample().
    bool dark() const { return rows_.empty(); }

    struct Sample {
        glm::dvec3 direction{0.0};  ///< unit, away from the scene
        double pdf = 0.0;           ///< per steradian, > 0
    };
    Sample sample(Random& random) const;

    /// Density of sample() for `direction` (unit), per steradian; 0 in directions without light.
    double pdf(const glm::dvec3& direction) const;

private:
    double cell_pdf(std::size_t column, std::size_t row) const;
    double row_solid_angle(std::size_t row) const;
    std::span<const float> columns(std::size_t row) const;

    std::size_t width_ = 0, height_ = 0;
    double rotation_ = 0.0;       ///< Environment::rotation, reduced to half a turn; the grid is unrotated
    std::vector<double> rows_;    ///< cumulative share of the rows' light, height_ + 1 values from 0 to 1
    std::vector<float> columns_;  ///< cumulative share within each row, width_ + 1 values per row
};

}  // namespace pellucid::reference
