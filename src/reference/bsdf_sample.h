#pragma once

#include <glm/glm.hpp>

namespace pellucid::reference {

/// BSDF times |cos theta_i|, without the share of perfect mirrors. Rough glass gives an unbiased estimate,
/// so that two calls may differ.
///
/// `pdf` is for the weights of multiple importance sampling. It is the density, per steradian, with which an
/// opaque surface chooses wi. Rough glass has no closed form of that density and gives a stand-in. Any positive
/// function will do, as long as sample() and evaluate() give the same (Veach 1997, section 9.2.2).
struct BsdfValue {
    glm::dvec3 value{0.0};
    double pdf = 0.0;
};

struct BsdfSample {
    glm::dvec3 wi{0.0};
    glm::dvec3 weight{0.0};  ///< BSDF times |cos theta_i| over the density that chose wi
    double pdf = 0.0;        ///< as that of BsdfValue; 0 for a perfect mirror
    bool mirror = false;     ///< one of the directions that evaluate() knows nothing of
};

}  // namespace pellucid::reference
