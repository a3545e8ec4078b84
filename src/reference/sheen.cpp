#include "reference/sheen.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace pellucid::reference {
namespace {

using std::numbers::pi;

constexpr double kSmoothest = 0.1;  // fibres of less roughness are seen nowhere but at the silhouette

/// The paper's fit of Smith's auxiliary function.
double lambda(double cos_theta, double alpha) {
    const double t = (1.0 - alpha) * (1.0 - alpha);
    const auto fitted = [t](double smooth, double rough) { return t * smooth + (1.0 - t) * rough; };
    const double a = fitted(25.3245, 21.5473), b = fitted(3.32435, 3.82987), c = fitted(0.16801, 0.19823),
                 d = fitted(-1.27393, -1.97760), e = fitted(-4.85967, -4.32054);
    const auto l = [&](double x) { return a / (1.0 + b * std::pow(x, c)) + d * x + e; };
    return cos_theta < 0.5 ? std::exp(l(cos_theta)) : std::exp(2.0 * l(0.5) - l(1.0 - cos_theta));
}

constexpr int kSide = 24;
using Table = std::array<std::array<double, kSide>, kSide>;  // by roughness and cosine

double integral(double cos_o, double roughness) {
    constexpr int kSteps = 32;
    const glm::dvec3 wo(std::sqrt(1.0 - cos_o * cos_o), 0.0, cos_o);
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const double z = (i + 0.5) / kSteps, r = std::sqrt(1.0 - z * z);
        for (int j = 0; j < kSteps; ++j) {
            const double angle = (j + 0.5) / kSteps * pi;
            sum += z * sheen(wo, {r * std::cos(angle), r * std::sin(angle), z}, roughness);
        }
    }
    return 2.0 * pi * sum / (kSteps * kSteps);
}

Table tabulate() {
    Table table;
    for (int i = 0; i < kSide; ++i)
        for (int j = 0; j < kSide; ++j)
            table[std::size_t(i)][std::size_t(j)] =
                integral(std::max(double(j) / (kSide - 1), 1e-3), double(i) / (kSide - 1));
    return table;
}

}  // namespace

double sheen(const glm::dvec3& wo, const glm::dvec3& wi, double roughness) {
    const double cos_o = std::max(wo.z, 1e-6), cos_i = std::max(wi.z, 1e-6);
    const double r = std::max(roughness, kSmoothest), alpha = r * r, power = 1.0 / alpha;
    const glm::dvec3 m = glm::normalize(wo + wi);
    const double sine2 = std::max(1.0 - m.z * m.z, 0.0);
    const double density = (2.0 + power) * std::pow(sine2, 0.5 * power) / (2.0 * pi);
    return density / ((1.0 + lambda(cos_o, alpha) + lambda(cos_i, alpha)) * 4.0 * cos_o * cos_i);
}

double sheen_albedo(double cos_theta, double roughness) {
    static const Table table = tabulate();
    const double x = std::clamp(cos_theta, 0.0, 1.0) * (kSide - 1), y = std::clamp(roughness, 0.0, 1.0) * (kSide - 1);
    const auto j = std::size_t(std::min(int(x), kSide - 2)), i = std::size_t(std::min(int(y), kSide - 2));
    const double u = x - double(j), v = y - double(i);
    return glm::mix(glm::mix(table[i][j], table[i][j + 1], u), glm::mix(table[i + 1][j], table[i + 1][j + 1], u), v);
}

}  // namespace pellucid::reference
