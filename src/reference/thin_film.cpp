#include "reference/thin_film.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid::reference {
namespace {

using std::numbers::pi;

double schlick(double at_normal, double cos_theta) {
    return at_normal + (1.0 - at_normal) * std::pow(std::clamp(1.0 - cos_theta, 0.0, 1.0), 5.0);
}

double reflectance_head_on(double n, double other) {
    const double root = (n - other) / (n + other);
    return root * root;
}

/// Fourier transform of the eye's sensitivities, linear Rec.709, at an optical path difference, m. The paper's supplement
/// fits Gaussians to the CIE colour matching functions: peak, frequency (1/m) and variance (1/m2).
glm::dvec3 sensitivity(double path_difference, const glm::dvec3& phase_shift) {
    struct Gaussian {
        double peak, position, variance;
    };
    constexpr Gaussian kX{5.4856e-13, 1.6810e+06, 4.3278e+09}, kY{4.4201e-13, 1.7953e+06, 9.3046e+09},
        kZ{5.2481e-13, 2.2084e+06, 6.6121e+09}, kXBlue{9.7470e-14, 2.2399e+06, 4.5282e+09};
    constexpr double kNormalization = 1.0685e-7;
    const double phase = 2.0 * pi * path_difference;
    const auto value = [&](const Gaussian& g, double shift) {
        return g.peak * std::sqrt(2.0 * pi * g.variance) * std::cos(g.position * phase + shift) *
               std::exp(-g.variance * phase * phase) / kNormalization;
    };
    const glm::dvec3 xyz(value(kX, phase_shift.x) + value(kXBlue, phase_shift.x), value(kY, phase_shift.y),
                         value(kZ, phase_shift.z));
    return {3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
            -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
            0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z};
}

}  // namespace

glm::dvec3 film_reflectance(double cos_theta, double film_ior, double thickness_nm, const glm::dvec3& at_normal) {
    if (thickness_nm <= 0.0) {  // there is none
        glm::dvec3 plain;
        for (int k = 0; k < 3; ++k) plain[k] = schlick(at_normal[k], cos_theta);
        return plain;
    }
    const double fade = std::clamp(thickness_nm / 0.03, 0.0, 1.0);
    const double n = 1.0 + (film_ior - 1.0) * fade * fade * (3.0 - 2.0 * fade);
    const double cos2 = 1.0 - (1.0 - cos_theta * cos_theta) / (n * n);
    if (cos2 < 0.0) return glm::dvec3(1.0);  // total reflection
    const double cos_film = std::sqrt(cos2);
    const double r12 = schlick(reflectance_head_on(n, 1.0), cos_theta), t121 = 1.0 - r12;
    const double path_difference = 2.0 * n * thickness_nm * 1e-9 * cos_film;

    glm::dvec3 r23(0.0), shift(0.0);
    for (int k = 0; k < 3; ++k) {
        const double root = std::sqrt(std::clamp(at_normal[k], 0.0, 0.9999));
        const double base_ior = (1.0 + root) / (1.0 - root);
        r23[k] = schlick(reflectance_head_on(base_ior, n), cos_film);
        shift[k] = pi + (base_ior < n ? pi : 0.0);  // from inside, the film's own face shifts by pi, too
    }
    const glm::dvec3 r123 = glm::clamp(r12 * r23, 1e-5, 0.9999);
    const glm::dvec3 first = t121 * t121 * r23 / (1.0 - r123);
    glm::dvec3 sum = r12 + first, term = first - t121;
    for (int order = 1; order <= 2; ++order) {
        term *= glm::sqrt(r123);
        sum += term * 2.0 * sensitivity(order * path_difference, double(order) * shift);
    }
    return glm::clamp(sum, 0.0, 1.0);
}

}  // namespace pellucid::reference
