// Where things are in an environment, and how much light they give.

#include <pellucid/environment.h>
#include <pellucid/error.h>

#include "core/math.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>

namespace pellucid {
namespace {

/// 8 x 4 texels, each telling its column and row.
Environment numbered_map() {
    Environment environment;
    environment.kind = Environment::Kind::kMap;
    environment.map = Image(8, 4, 3);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x) {
            environment.map.at(x, y)[0] = float(x);
            environment.map.at(x, y)[1] = float(y);
            environment.map.at(x, y)[2] = 1.0f;
        }
    return environment;
}

/// Direction at (u, v) of an equirectangular map, from the definition in environment.h.
glm::vec3 direction_at(double u, double v) {
    const double longitude = (u - 0.5) * 2.0 * std::numbers::pi, colatitude = v * std::numbers::pi;
    return glm::vec3(std::sin(colatitude) * std::cos(longitude), std::cos(colatitude),
                     std::sin(colatitude) * std::sin(longitude));
}

void expect_near(glm::vec3 actual, glm::vec3 expected, float tolerance) {
    EXPECT_LT(glm::length(actual - expected), tolerance)
        << actual.x << ' ' << actual.y << ' ' << actual.z << " against " << expected.x << ' ' << expected.y << ' '
        << expected.z;
}

TEST(EnvironmentMap, OrientationOfTheAxes) {
    const Environment map = numbered_map();
    // At v = 1/2, between rows 1 and 2. u = 1/2 is between columns 3 and 4.
    expect_near(radiance(map, {1, 0, 0}), {3.5f, 1.5f, 1}, 1e-5f);
    expect_near(radiance(map, {0, 0, -1}), {1.5f, 1.5f, 1}, 1e-5f);  // u = 1/4
    expect_near(radiance(map, {0, 0, 1}), {5.5f, 1.5f, 1}, 1e-5f);   // u = 3/4
    expect_near(radiance(map, {-1, 0, 0}), {3.5f, 1.5f, 1}, 1e-5f);  // seam: columns 7 and 0
    EXPECT_EQ(radiance(map, {0, 1, 0}).y, 0.0f);                     // top row
    EXPECT_EQ(radiance(map, {0, -1, 0}).y, 3.0f);                    // bottom row
}

TEST(EnvironmentMap, TexelCentresAreExact) {
    const Environment map = numbered_map();
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x)
            expect_near(radiance(map, direction_at((x + 0.5) / 8.0, (y + 0.5) / 4.0)), {float(x), float(y), 1}, 1e-5f);
}

TEST(EnvironmentMap, SeamIsContinuous) {
    const Environment map = numbered_map();
    expect_near(radiance(map, direction_at(1e-6, 0.4)), radiance(map, direction_at(1.0 - 1e-6, 0.4)), 1e-3f);
    // A quarter texel on either side of the seam leans to its own column.
    EXPECT_NEAR(radiance(map, direction_at(1.0 - 0.25 / 8.0, 0.4)).x, 0.75f * 7.0f, 1e-4f);
    EXPECT_NEAR(radiance(map, direction_at(0.25 / 8.0, 0.4)).x, 0.25f * 7.0f, 1e-4f);
}

TEST(EnvironmentMap, SmallestMapAndSlightlyLongDirections) {
    Environment map;
    map.kind = Environment::Kind::kMap;
    map.map = Image(1, 1, 3);
    map.map.pixels = {1, 2, 3};
    for (const glm::vec3 d :
         {glm::vec3(0, 1.0000001f, 0), glm::vec3(0, -1.0000001f, 0), glm::vec3(-1, 0, -0.0f), glm::vec3(-1, 0, 0)})
        expect_near(radiance(map, d), {1, 2, 3}, 1e-6f);
}

/// Right-handed about +Y.
glm::vec3 turned(glm::vec3 d, float angle) {
    return glm::vec3(glm::rotate(glm::mat4(1.0f), angle, glm::vec3(0, 1, 0)) * glm::vec4(d, 0.0f));
}

TEST(PlacedEnvironment, AQuarterTurnBringsLightFromXToMinusZ) {
    Environment map = numbered_map();
    const glm::vec3 from_x = radiance(map, {1, 0, 0}), from_minus_z = radiance(map, {0, 0, -1});
    map.rotation = 0.5f * kPi;
    expect_near(radiance(map, {0, 0, -1}), from_x, 1e-5f);
    expect_near(radiance(map, {-1, 0, 0}), from_minus_z, 1e-5f);
}

TEST(PlacedEnvironment, RadianceTurnsAndScales) {
    for (const Environment& environment : {numbered_map(), load_environment("studio"), load_environment("sky")}) {
        Environment placed = environment;
        placed.rotation = 2.2f;
        placed.intensity = 3.0f;
        for (const glm::vec3 from : {glm::vec3(1, 2, 3), glm::vec3(-2, 0.5f, 1), glm::vec3(0.1f, -1, -0.4f)}) {
            const glm::vec3 d = glm::normalize(from);
            expect_near(radiance(placed, turned(d, 2.2f)), 3.0f * radiance(environment, d), 2e-3f);
        }
    }
}

TEST(ProceduralEnvironment, EveryDirectionIsFiniteAndInRange) {
    for (const char* name : {"studio", "checker", "sky", "uniform"}) {
        SCOPED_TRACE(name);
        const Environment environment = load_environment(name);
        float least = 1e30f, most = 0.0f;
        for (int y = 0; y <= 400; ++y)
            for (int x = 0; x <= 800; ++x) {
                const glm::vec3 value = radiance(environment, direction_at(x / 800.0, y / 400.0));
                for (int channel = 0; channel < 3; ++channel) {
                    ASSERT_TRUE(std::isfinite(value[channel])) << x << ' ' << y;
                    least = std::min(least, value[channel]);
                    most = std::max(most, value[channel]);
                }
            }
        EXPECT_GE(least, 0.03f);
        EXPECT_LE(most, environment.kind == Environment::Kind::kSky      ? 205.0f
                        : environment.kind == Environment::Kind::kStudio ? 9.0f
                                                                         : 1.0f);
    }
}

TEST(ProceduralEnvironment, CheckerTellsDirections) {
    const Environment checker = load_environment("checker");
    // Centres of light cells (column + row even) in each quarter, just above the horizon (row 4).
    const auto cell = [&](int column, int row) {
        return radiance(checker, direction_at((column + 0.5) / 24.0, (row + 0.5) / 12.0));
    };
    const glm::vec3 red = cell(2, 4), yellow = cell(8, 4), green = cell(14, 4), blue = cell(20, 4);
    EXPECT_GT(red.r, 1.4f * red.g);
    EXPECT_GT(yellow.g, 1.4f * yellow.b);
    EXPECT_GT(green.g, 1.4f * green.r);
    EXPECT_GT(blue.b, 1.4f * blue.r);
    EXPECT_GT(cell(8, 4).g, cell(8, 8).g);  // upper half lighter
    EXPECT_GT(cell(8, 4).g, cell(9, 4).g);  // neighbours differ
    // Exact edges: a ten-thousandth of a cell apart.
    const glm::vec3 before = radiance(checker, direction_at(9.9999 / 24.0, 4.5 / 12.0));
    const glm::vec3 after = radiance(checker, direction_at(10.0001 / 24.0, 4.5 / 12.0));
    expect_near(before, cell(9, 4), 1e-6f);
    expect_near(after, cell(10, 4), 1e-6f);
}

TEST(ProceduralEnvironment, StudioIsNotItsOwnMirrorImage) {
    const Environment studio = load_environment("studio");
    const glm::vec3 right = radiance(studio, glm::normalize(glm::vec3(0.866f, 0.35f, -0.5f)));
    const glm::vec3 left = radiance(studio, glm::normalize(glm::vec3(-0.9063f, 0.25f, -0.4226f)));
    EXPECT_GT(right.b, right.r);  // cool
    EXPECT_GT(left.r, left.b);    // warm
    EXPECT_GT(right.g, 1.5f * left.g);
}

/// E(n) from the nine coefficients, written out in their documented order.
glm::vec3 irradiance(const std::array<glm::vec3, 9>& c, glm::vec3 n) {
    return 0.282095f * c[0] + 0.488603f * (n.y * c[1] + n.z * c[2] + n.x * c[3]) +
           1.092548f * (n.x * n.y * c[4] + n.y * n.z * c[5] + n.x * n.z * c[7]) +
           0.315392f * (3.0f * n.z * n.z - 1.0f) * c[6] + 0.546274f * (n.x * n.x - n.y * n.y) * c[8];
}

TEST(Irradiance, OfAUniformEnvironmentIsPiEverywhere) {
    Environment map;
    map.kind = Environment::Kind::kMap;
    map.map = Image(256, 128, 3);
    std::fill(map.map.pixels.begin(), map.map.pixels.end(), 1.0f);
    for (const Environment& environment : {load_environment("uniform"), map}) {
        const auto coefficients = irradiance_coefficients(environment);
        for (const glm::vec3 n :
             {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, -1), glm::normalize(glm::vec3(1, -2, 3))})
            expect_near(irradiance(coefficients, n), glm::vec3(kPi), 2e-3f);
    }
}

TEST(Irradiance, OfALinearEnvironmentIsExact) {
    // L(w) = 1 + a.w is of order 1, so E(n) = pi + (2 pi / 3) a.n without error.
    const glm::vec3 a(0.3f, -0.4f, 0.5f);
    Environment map;
    map.kind = Environment::Kind::kMap;
    map.map = Image(256, 128, 3);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 256; ++x) {
            const glm::vec3 d = direction_at((x + 0.5) / 256.0, (y + 0.5) / 128.0);
            for (int channel = 0; channel < 3; ++channel) map.map.at(x, y)[channel] = 1.0f + glm::dot(a, d);
        }
    const auto coefficients = irradiance_coefficients(map);
    for (const glm::vec3 n :
         {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1), glm::normalize(glm::vec3(-1, 2, 1))})
        expect_near(irradiance(coefficients, n), glm::vec3(kPi + 2.0f * kPi / 3.0f * glm::dot(a, n)), 2e-3f);
}

TEST(Irradiance, TurnsAndScalesWithTheEnvironment) {
    Environment map = numbered_map();
    for (const Environment& environment : {map, load_environment("studio")}) {
        Environment placed = environment;
        placed.rotation = -0.8f;
        placed.intensity = 0.25f;
        const auto before = irradiance_coefficients(environment), after = irradiance_coefficients(placed);
        for (const glm::vec3 from : {glm::vec3(1, 0, 0), glm::vec3(0.3f, -0.5f, 2), glm::vec3(-1, 1, -1)}) {
            const glm::vec3 n = glm::normalize(from), expected = 0.25f * irradiance(before, n);
            expect_near(irradiance(after, turned(n, -0.8f)), expected, 2e-3f * glm::length(expected));
        }
    }
}

TEST(Irradiance, FormulaAndItsMapAgree) {
    for (const char* name : {"studio", "checker", "sky"}) {
        SCOPED_TRACE(name);
        const Environment formula = load_environment(name);
        Environment map;
        map.kind = Environment::Kind::kMap;
        map.map = Image(2048, 1024, 3);
        for (int y = 0; y < 1024; ++y)
            for (int x = 0; x < 2048; ++x) {
                const glm::vec3 value = radiance(formula, direction_at((x + 0.5) / 2048.0, (y + 0.5) / 1024.0));
                for (int channel = 0; channel < 3; ++channel) map.map.at(x, y)[channel] = value[channel];
            }
        const auto from_formula = irradiance_coefficients(formula);
        const auto from_map = irradiance_coefficients(map);
        for (int i = 0; i < 9; ++i)  // half a percent of the whole
            expect_near(from_formula[i], from_map[i], 0.005f * glm::length(from_map[0]));
    }
}

/// A file that is gone when the test is over.
class TemporaryFile {
public:
    explicit TemporaryFile(const std::string& name) : path_(std::filesystem::path(testing::TempDir()) / name) {}
    ~TemporaryFile() { std::filesystem::remove(path_); }
    std::string path() const { return path_.string(); }

private:
    std::filesystem::path path_;
};

TEST(LoadEnvironment, MapsAreCheckedAndRepaired) {
    const TemporaryFile file("pellucid_test_environment.exr");
    Image image(8, 4, 4);
    std::fill(image.pixels.begin(), image.pixels.end(), 0.5f);
    image.at(1, 2)[0] = -1.0f;
    image.at(3, 2)[1] = std::numeric_limits<float>::infinity();
    image.at(4, 2)[2] = std::numeric_limits<float>::quiet_NaN();
    write_image(file.path(), image);

    std::string warning;
    const Environment environment = load_environment(file.path(), &warning);
    EXPECT_EQ(environment.kind, Environment::Kind::kMap);
    ASSERT_EQ(environment.map.channels, 3);
    EXPECT_EQ(environment.map.at(0, 0)[2], 0.5f);
    for (const int x : {1, 3, 4}) EXPECT_EQ(glm::make_vec3(environment.map.at(x, 2)), glm::vec3(0));
    EXPECT_NE(warning.find("3 texels"), std::string::npos) << warning;
    EXPECT_EQ(warning.find("2:1"), std::string::npos) << warning;
}

TEST(LoadEnvironment, GreyIsExpandedAndOddAspectWarned) {
    const TemporaryFile file("pellucid_test_grey.exr");
    Image image(4, 4, 1);
    std::fill(image.pixels.begin(), image.pixels.end(), 0.25f);
    write_image(file.path(), image);
    std::string warning = "from before";
    const Environment environment = load_environment(file.path(), &warning);
    EXPECT_EQ(glm::make_vec3(environment.map.at(3, 3)), glm::vec3(0.25f));
    EXPECT_NE(warning.find("2:1"), std::string::npos) << warning;
    load_environment("studio", &warning);
    EXPECT_EQ(warning, "");
}

TEST(LoadEnvironment, UnknownNamesListTheKnownOnes) {
    for (const char* name : {"nowhere", "", "picture.png", "Studio"}) {
        try {
            load_environment(name);
            FAIL() << name;
        } catch (const Error& error) {
            for (const char* known : {"studio", "checker", "sky", "uniform", ".hdr", ".exr"})
                EXPECT_NE(std::string(error.what()).find(known), std::string::npos) << error.what();
        }
    }
    EXPECT_THROW(load_environment("missing.hdr"), Error);
}

}  // namespace
}  // namespace pellucid
