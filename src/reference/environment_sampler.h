#pragma once

#include "reference/random.h"

#include <pellucid/environment.h>

#include <glm/glm.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace pellucid::reference {

/// Chooses directions about as often as light comes from them: by the mean luminance of the cells of
/// an equirectangular grid, uniform in solid angle within a cell (Pharr, Jakob & Humphreys, Physically
/// Based Rendering, 4th ed., 2023, section 12.5, apart from that). A map has one cell per texel; formulas
/// are tabulated.
///
/// Where a cell's share of the light is too small for a float, pdf() is 0 though radiance may not be:
/// combine with directions chosen by the surface (multiple importance sampling).
class EnvironmentSampler {
public:
    /// `environment` must be checked.
    explicit EnvironmentSampler(const Environment& environment);

    /// True if no light comes from anywhere: sample() must not be called.
    bool dark() const { return rows_.empty(); }

    struct Sample {
        glm::dvec3 direction{0.0};  ///< unit, away from the scene
        double pdf = 0.0;           ///< per steradian, > 0
    };
    Sample sample(Random& random) const;

    /// Density with which sample() chooses `direction` (unit), per steradian; 0 where there is no light.
    double pdf(const glm::dvec3& direction) const;

private:
    double cell_pdf(std::size_t column, std::size_t row) const;
    double row_solid_angle(std::size_t row) const;
    std::span<const float> columns(std::size_t row) const;

    std::size_t width_ = 0, height_ = 0;
    double rotation_ = 0.0;       ///< Environment::rotation within half a turn; the grid's cells are those without it
    std::vector<double> rows_;    ///< cumulative share of the rows' light, height_ + 1 values from 0 to 1
    std::vector<float> columns_;  ///< likewise within each row, width_ + 1 values per row
};

}  // namespace pellucid::reference
