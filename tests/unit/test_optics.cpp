// The vector forms against scalar laws and known answers.

#include "optics/interface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace pellucid {
namespace {

using glm::dvec3;

constexpr double kPiDouble = std::numbers::pi;
constexpr double kIndices[] = {1.0, 1.0003, 1.333, 1.5, 1.77, 2.417};

/// A unit direction that meets the surface with unit normal `normal` at `theta_i`.
dvec3 incident(dvec3 normal, dvec3 tangent, double theta_i) {
    return std::sin(theta_i) * tangent - std::cos(theta_i) * normal;
}

/// Some thousand surfaces: normal and a unit tangent, in general position.
template <class Check>
void for_many_surfaces(const Check& check) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal_distribution;
    const auto direction = [&] {
        return glm::normalize(
            dvec3(normal_distribution(random), normal_distribution(random), normal_distribution(random)));
    };
    for (int i = 0; i < 1000; ++i) {
        const dvec3 normal = direction();
        const dvec3 tangent = glm::normalize(glm::cross(normal, direction()));
        check(normal, tangent, std::uniform_real_distribution<double>(0.0, 0.5 * kPiDouble)(random));
    }
}

TEST(Refraction, ObeysTheLawOfSines) {
    for_many_surfaces([](dvec3 normal, dvec3 tangent, double theta_i) {
        for (const double n_i : kIndices)
            for (const double n_t : kIndices) {
                const dvec3 direction = incident(normal, tangent, theta_i);
                dvec3 refracted(0.0);
                const bool transmitted = refract_direction(direction, normal, n_i / n_t, refracted);
                const double sin_t = n_i / n_t * std::sin(theta_i);
                ASSERT_EQ(transmitted, sin_t <= 1.0);
                if (!transmitted) continue;
                EXPECT_NEAR(glm::length(refracted), 1.0, 1e-12);
                EXPECT_NEAR(glm::length(glm::cross(refracted, normal)), sin_t, 1e-7);
                EXPECT_NEAR(glm::dot(refracted, glm::cross(direction, normal)), 0.0, 1e-12);
                EXPECT_GE(glm::dot(refracted, tangent), 0.0);  // goes on the way it went
                EXPECT_LE(glm::dot(refracted, normal), 0.0);   // and to the other side
            }
    });
}

TEST(Refraction, RunsBackwardsTheSameWay) {
    for_many_surfaces([](dvec3 normal, dvec3 tangent, double theta_i) {
        const dvec3 direction = incident(normal, tangent, theta_i);
        dvec3 inside(0.0), back(0.0);
        ASSERT_TRUE(refract_direction(direction, normal, 1.0 / 1.5, inside));
        ASSERT_TRUE(refract_direction(-inside, -normal, 1.5, back));
        EXPECT_LT(glm::length(back + direction), 1e-6);
    });
}

TEST(Refraction, EqualMediaDoNotBend) {
    for_many_surfaces([](dvec3 normal, dvec3 tangent, double theta_i) {
        const dvec3 direction = incident(normal, tangent, theta_i);
        dvec3 refracted(0.0);
        ASSERT_TRUE(refract_direction(direction, normal, 1.0, refracted));
        EXPECT_LT(glm::length(refracted - direction), 1e-12);
    });
    // Also at grazing incidence in float, where 1 - (1 - cos^2) would lose the cosine.
    const glm::vec3 grazing = glm::normalize(glm::vec3(1.0f, -1e-5f, 0.0f));
    glm::vec3 refracted(0.0f);
    ASSERT_TRUE(refract_direction(grazing, glm::vec3(0, 1, 0), 1.0f, refracted));
    EXPECT_EQ(refracted.y, grazing.y);
}

TEST(Refraction, ReflectsTotallyBeyondTheCriticalAngle) {
    const dvec3 normal(0, 1, 0), tangent(1, 0, 0);
    for (const double n : {1.333, 1.5, 2.417}) {
        const double critical = std::asin(1.0 / n);
        dvec3 refracted(0.0);
        EXPECT_TRUE(refract_direction(incident(normal, tangent, critical - 1e-9), normal, n, refracted));
        EXPECT_NEAR(refracted.x, 1.0, 1e-6);  // leaves along the surface
        refracted = dvec3(7.0);
        EXPECT_FALSE(refract_direction(incident(normal, tangent, critical + 1e-9), normal, n, refracted));
        EXPECT_EQ(refracted, dvec3(7.0));
        EXPECT_LT(fresnel_dielectric(std::cos(critical - 1e-3), n), 1.0);
        EXPECT_EQ(fresnel_dielectric(std::cos(critical + 1e-9), n), 1.0);
    }
}

TEST(Refraction, NormalOnTheWrongSideIsGrazing) {
    // An interpolated normal may lean away from the ray; the result must stay a direction.
    const glm::vec3 direction = glm::normalize(glm::vec3(1.0f, 0.1f, 0.0f));
    glm::vec3 refracted(0.0f);
    ASSERT_TRUE(refract_direction(direction, glm::vec3(0, 1, 0), 1.0f / 1.5f, refracted));
    EXPECT_NEAR(glm::length(refracted), 1.0f, 1e-6f);
    EXPECT_LT(refracted.y, 0.0f);
    EXPECT_NEAR(glm::length(reflect_direction(direction, glm::vec3(0, 1, 0))), 1.0f, 1e-6f);
}

TEST(Refraction, SlabShiftsSidewaysByTheKnownAmount) {
    const double n = 1.5, thickness = 0.3;
    const dvec3 normal(0, 0, 1), tangent(1, 0, 0);
    for (const double theta_i : {0.0, 0.2, 0.7, 1.2, 1.5}) {
        const dvec3 direction = incident(normal, tangent, theta_i);
        dvec3 inside(0.0), out(0.0);
        ASSERT_TRUE(refract_direction(direction, normal, 1.0 / n, inside));
        ASSERT_TRUE(refract_direction(inside, normal, n, out));
        EXPECT_LT(glm::length(out - direction), 1e-7);
        const dvec3 exit = inside * (thickness / -inside.z);
        const double shift = glm::length(exit - direction * glm::dot(exit, direction));
        const double sin_i = std::sin(theta_i), cos_i = std::cos(theta_i);
        EXPECT_NEAR(shift, thickness * sin_i * (1.0 - cos_i / std::sqrt(n * n - sin_i * sin_i)), 1e-9);
    }
}

TEST(Reflection, KeepsTheAngleAndThePlane) {
    for_many_surfaces([](dvec3 normal, dvec3 tangent, double theta_i) {
        const dvec3 direction = incident(normal, tangent, theta_i);
        const dvec3 reflected = reflect_direction(direction, normal);
        EXPECT_NEAR(glm::dot(reflected, normal), std::cos(theta_i), 1e-12);
        EXPECT_NEAR(glm::dot(reflected, tangent), std::sin(theta_i), 1e-12);
        EXPECT_NEAR(glm::length(reflected), 1.0, 1e-12);
    });
}

TEST(Fresnel, NormalIncidence) {
    for (const double n_i : kIndices)
        for (const double n_t : kIndices)
            EXPECT_NEAR(fresnel_dielectric(1.0, n_i / n_t), std::pow((n_i - n_t) / (n_i + n_t), 2.0), 1e-15);
}

TEST(Fresnel, AgreesWithTheAngleForm) {
    // Fresnel's sine and tangent laws: Rs = (sin(i - t) / sin(i + t))^2, Rp likewise with tan.
    for (const double eta : {1.0 / 1.5, 1.0 / 2.417, 1.1, 1.5})
        for (double theta_i = 0.05; theta_i < 1.55; theta_i += 0.05) {
            const double sin_t = eta * std::sin(theta_i);
            if (sin_t >= 1.0) continue;
            const double theta_t = std::asin(sin_t);
            const double s = std::sin(theta_i - theta_t) / std::sin(theta_i + theta_t);
            const double p = std::tan(theta_i - theta_t) / std::tan(theta_i + theta_t);
            EXPECT_NEAR(fresnel_dielectric(std::cos(theta_i), eta), 0.5 * (s * s + p * p), 1e-12);
        }
}

TEST(Fresnel, BrewsterAngleReflectsOnlyS) {
    for (const double n : {1.333, 1.5, 2.417}) {
        const double brewster = std::atan(n);
        // There i + t is a right angle, so Rs = sin^2(i - t) and Rp = 0.
        const double s = std::sin(2.0 * brewster - 0.5 * kPiDouble);
        EXPECT_NEAR(fresnel_dielectric(std::cos(brewster), 1.0 / n), 0.5 * s * s, 1e-12);
    }
}

TEST(Fresnel, ReflectedAndTransmittedEnergyAddUp) {
    // Transmittance from its own amplitudes (Born & Wolf 1.5.2, equations 20 and 34).
    for (const double eta : {1.0 / 1.333, 1.0 / 1.5, 1.0 / 2.417, 1.2, 1.5})
        for (double theta_i = 0.0; theta_i < 1.57; theta_i += 0.01) {
            const double cos_i = std::cos(theta_i), sin_t = eta * std::sin(theta_i);
            if (sin_t >= 1.0) continue;
            const double cos_t = std::sqrt(1.0 - sin_t * sin_t);
            const double s = 2.0 * eta * cos_i / (eta * cos_i + cos_t);
            const double p = 2.0 * eta * cos_i / (cos_i + eta * cos_t);
            const double transmittance = cos_t / (eta * cos_i) * 0.5 * (s * s + p * p);
            EXPECT_NEAR(fresnel_dielectric(cos_i, eta) + transmittance, 1.0, 1e-12);
        }
}

TEST(Fresnel, SameFromBothSides) {
    for (double theta_i = 0.0; theta_i < 1.57; theta_i += 0.01) {
        const double cos_t = std::cos(std::asin(std::sin(theta_i) / 1.5));
        EXPECT_NEAR(fresnel_dielectric(std::cos(theta_i), 1.0 / 1.5), fresnel_dielectric(cos_t, 1.5), 1e-10);
    }
}

TEST(Fresnel, EdgeCases) {
    EXPECT_EQ(fresnel_dielectric(0.0f, 1.0f), 0.0f);  // no boundary, 0/0 in the formula
    EXPECT_EQ(fresnel_dielectric(0.5f, 1.0f), 0.0f);
    EXPECT_EQ(fresnel_dielectric(0.0f, 1.0f / 1.5f), 1.0f);
    EXPECT_EQ(fresnel_dielectric(-0.1f, 1.0f / 1.5f), 1.0f);
    EXPECT_EQ(fresnel_dielectric(0.0f, 1.5f), 1.0f);
    EXPECT_NEAR(fresnel_dielectric(1.00001f, 1.5f), 0.04f, 1e-6f);
}

TEST(Absorption, BeerLambert) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const dvec3 sigma_a(0.0, 0.5, 2.0);
    const dvec3 one = beer_lambert(sigma_a, 1.0);
    EXPECT_EQ(one.x, 1.0);
    EXPECT_DOUBLE_EQ(one.y, std::exp(-0.5));
    // Two stretches multiply.
    EXPECT_LT(glm::length(beer_lambert(sigma_a, 0.3) * beer_lambert(sigma_a, 0.7) - one), 1e-15);
    EXPECT_EQ(beer_lambert(dvec3(0.0, 1.0, kInfinity), 0.0), dvec3(1.0));
    EXPECT_EQ(beer_lambert(dvec3(0.0, 1.0, kInfinity), kInfinity), dvec3(1.0, 0.0, 0.0));
    EXPECT_EQ(beer_lambert(dvec3(kInfinity), 1e-6), dvec3(0.0));
}

TEST(Dispersion, FollowsTheDefinitionOfTheAbbeNumber) {
    const double ior = 1.5168, abbe = 64.17;  // crown glass, Schott N-BK7
    const dvec3 iors = ior_per_channel(ior, 20.0 / abbe);
    EXPECT_EQ(iors.y, ior);
    EXPECT_NEAR((ior - 1.0) / (iors.z - iors.x), abbe, 1e-9);
    EXPECT_EQ(ior_per_channel(1.7f, 0.0f), glm::vec3(1.7f));
    EXPECT_EQ(ior_per_channel(1.0f, 5.0f), glm::vec3(1.0f));
    EXPECT_GE(ior_per_channel(1.5f, 1000.0f).x, 1.0f);
}

}  // namespace
}  // namespace pellucid
