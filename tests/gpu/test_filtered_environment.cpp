// The environment as rough surfaces see it, against integrals over it.
#include "gpu/environment_images.h"
#include "gpu/structs.h"

#include "gpu/device_test.h"
#include "gpu_tests/shaders.h"

namespace pellucid::test {
namespace {

Environment formula(Environment::Kind kind) {
    Environment environment;
    environment.kind = kind;
    return environment;
}

/// Dim, with one bright texel: a sun of a third of a degree.
Environment sun_map(int width) {
    Environment environment;
    environment.kind = Environment::Kind::kMap;
    environment.map = Image(width, width / 2, 3);
    std::fill(environment.map.pixels.begin(), environment.map.pixels.end(), 0.25f);
    std::fill_n(environment.map.at(width / 3, width / 8), 3, 2e4f);
    return environment;
}

/// Points of equal solid angle on a Fibonacci spiral.
std::vector<glm::vec3> spread_directions(int count) {
    std::vector<glm::vec3> directions;
    for (int i = 0; i < count; ++i) {
        const double y = 1.0 - (2.0 * i + 1.0) / count, r = std::sqrt(1.0 - y * y), longitude = 2.399963229728653 * i;
        directions.emplace_back(r * std::cos(longitude), y, r * std::sin(longitude));
    }
    return directions;
}

glm::dvec3 mean(const std::vector<glm::vec3>& values) {
    glm::dvec3 sum(0.0);
    for (const glm::vec3& value : values) sum += glm::dvec3(value);
    return sum / double(values.size());
}

/// Mean of the environment over all directions, texel by texel if it is a map.
glm::dvec3 mean_radiance(const Environment& environment) {
    // Irradiance coefficient 0 is pi times the mean's, over the harmonic 1 / (2 sqrt(pi)) of that order.
    return glm::dvec3(irradiance_coefficients(environment)[0]) / (3.141592653589793 * std::sqrt(4 * 3.141592653589793));
}

class FilteredEnvironment : public DeviceTest {
protected:
    void set(const Environment& environment) {
        map_ = upload_environment(device(), environment);
        filtered_.emplace(device());
        filtered_->filter(workspace(), recorder(), environment, map_);
        recorder().submit_and_wait();
        constants_ = {};
        set_environment(constants_, environment);
    }
    std::vector<glm::vec3> look(const std::vector<glm::vec3>& directions, float roughness) {
        const Buffer& frame = workspace().buffer("frame", sizeof(constants_), true);
        const Buffer& lookups = workspace().buffer("lookups", directions.size() * sizeof(glm::vec4), true);
        const Buffer& answers = workspace().buffer("answers", lookups.size(), true);
        std::vector<glm::vec4> data;
        for (const glm::vec3& direction : directions) data.emplace_back(direction, roughness);
        std::memcpy(frame.mapped(), &constants_, sizeof(constants_));
        std::memcpy(lookups.mapped(), data.data(), lookups.size());
        recorder().compute(
            workspace().compute(shaders::filtered_radiance_comp),
            {reads("Frame", frame), reads("Lookups", lookups), writes("Answers", answers),
             reads_layer("environment_map", map_, 0), reads_layer("filtered_environment", filtered_->filtered, 0)},
            {std::uint32_t(directions.size()), 1});
        recorder().submit_and_wait();
        std::vector<glm::vec3> seen;
        for (const glm::vec4& answer : read_back<glm::vec4>(answers)) seen.emplace_back(answer);
        return seen;
    }

private:
    GpuImage map_;
    std::optional<pellucid::FilteredEnvironment> filtered_;
    gpu::FrameConstants constants_{};
};

TEST_F(FilteredEnvironment, SmoothIsTheEnvironmentItself) {
    const Environment studio = formula(Environment::Kind::kStudio);
    set(studio);
    const std::vector<glm::vec3> directions = spread_directions(200), seen = look(directions, 0.0f);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        EXPECT_LT(glm::distance(seen[i], radiance(studio, directions[i])), 2e-3f * (1.0f + glm::length(seen[i]))) << i;
    }
}

TEST_F(FilteredEnvironment, UniformStaysUniform) {
    set(uniform_environment({0.5f, 1.0f, 2.0f}));
    for (const float roughness : {0.05f, 0.125f, 0.3f, 0.7f, 1.0f}) {
        for (const glm::vec3& seen : look(spread_directions(500), roughness)) {
            ASSERT_LT(glm::distance(seen, glm::vec3(0.5f, 1.0f, 2.0f)), 1e-5f) << roughness;  // rounding alone
        }
    }
}

// A lobe is a mean: over all directions, every roughness sees as much light as there is.
TEST_F(FilteredEnvironment, KeepsTheLightThatThereIs) {
    const std::pair<const char*, Environment> environments[] = {{"studio", formula(Environment::Kind::kStudio)},
                                                                {"checker", formula(Environment::Kind::kChecker)},
                                                                {"sky", formula(Environment::Kind::kSky)},
                                                                {"small sun", sun_map(1024)}};
    for (const auto& [name, environment] : environments) {
        set(environment);
        const glm::dvec3 expected = mean_radiance(environment);
        for (int level = 1; level <= PELLUCID_FILTER_LEVELS; ++level) {
            const float roughness = float(level) / float(PELLUCID_FILTER_LEVELS);
            const glm::dvec3 seen = mean(look(spread_directions(1 << 17), roughness));
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c] / expected[c], 1.0, 0.01) << name << " " << roughness;
        }
    }
}

/// Share per steradian of the light at `angle` (radians) from the middle of the lobe of GGX reflection that is seen along
/// the normal: density of facets, and what others do not shadow; not normalised.
double lobe(double roughness, double angle) {
    const double alpha2 = std::pow(roughness, 4.0), s = std::sin(0.5 * angle), c = std::cos(0.5 * angle);
    const double spread = s * s + alpha2 * c * c, tangent = std::tan(angle);
    return alpha2 / (spread * spread) / (1.0 + std::sqrt(1.0 + alpha2 * tangent * tangent));
}

// A sun of one texel shows the lobe itself: as round and smooth as it is, without a speck of its own. Samples are
// means over squares, and levels have texels of up to 6 degrees: seen are 11% of the peak.
TEST_F(FilteredEnvironment, SmallSunIsSpreadByTheLobe) {
    constexpr int kWidth = 1024, kSteps = 4000, kAround = 24;
    constexpr double kPiDouble = 3.141592653589793;
    const Environment environment = sun_map(kWidth);
    set(environment);
    const double texel = 2.0 * kPiDouble / kWidth, down = (kWidth / 8 + 0.5) * texel;
    const double longitude = (kWidth / 3 + 0.5) * texel - kPiDouble;
    const glm::vec3 sun(std::sin(down) * std::cos(longitude), std::cos(down), std::sin(down) * std::sin(longitude));
    const double light = (2e4 - 0.25) * texel * texel * std::sin(down);
    const glm::vec3 across = glm::normalize(glm::cross(sun, glm::vec3(1, 0, 0))), along = glm::cross(sun, across);

    for (const float roughness : {0.25f, 0.375f, 0.5f, 0.75f, 1.0f}) {
        double whole = 0.0;
        for (int i = 0; i < kSteps; ++i) {
            const double angle = (i + 0.5) / kSteps * 0.5 * kPiDouble;
            whole += lobe(roughness, angle) * 2.0 * kPiDouble * std::sin(angle) * 0.5 * kPiDouble / kSteps;
        }
        const double peak = light * lobe(roughness, 0.0) / whole;
        for (const double share : {0.0, 0.5, 1.0, 2.0, 4.0}) {  // of the lobe's half width
            const double angle = std::min(share * 2.0 * double(roughness * roughness), 1.5);
            std::vector<glm::vec3> directions;
            for (int i = 0; i < kAround; ++i) {
                const auto turn = float(2.0 * kPiDouble * i / kAround);
                directions.push_back(float(std::cos(angle)) * sun +
                                     float(std::sin(angle)) * (std::cos(turn) * across + std::sin(turn) * along));
            }
            for (const glm::vec3& seen : look(directions, roughness)) {
                EXPECT_NEAR(double(seen.g) - 0.25, light * lobe(roughness, angle) / whole, 0.15 * peak)
                    << "roughness " << roughness << ", " << angle << " rad from the sun, peak " << peak;
            }
        }
    }
}

}  // namespace
}  // namespace pellucid::test
