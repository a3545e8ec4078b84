#pragma once

// Scattering in a medium. Twin of phase.glsl.

#include "core/math.h"

#include <cmath>
#include <numbers>

namespace pellucid {

/// Henyey and Greenstein, Diffuse radiation in the galaxy, 1941: share of scattered light per steradian. `cos_theta`:
/// cosine of the scattering angle (1: forward). `g`: its mean, -1..1, both excluded; 0 is isotropic.
template <class Real>
Real henyey_greenstein(Real cos_theta, Real g) {
    const Real base = std::max(Real(1) + g * g - Real(2) * g * cos_theta, Real(1e-6));
    return (Real(1) - g * g) / (Real(4) * std::numbers::pi_v<Real> * base * std::sqrt(base));
}

}  // namespace pellucid
