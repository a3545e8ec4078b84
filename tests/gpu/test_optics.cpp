// The shader side of optics against its C++ twin.
#include "optics/interface.h"

#include "gpu/device_test.h"
#include "gpu_tests/shaders.h"

#include <random>

namespace pellucid::test {
namespace {

struct Case {
    glm::vec4 direction, normal;
};
struct Answer {
    glm::vec4 refracted, reflected, transmitted;
};

std::vector<Case> random_cases(std::size_t count) {
    std::mt19937 generator(1);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    const auto unit = [&] {
        return glm::normalize(glm::vec3(normal(generator), normal(generator), normal(generator)));
    };
    std::vector<Case> cases;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 n = unit();
        glm::vec3 d = unit();
        if (glm::dot(d, n) > 0.0f) d = -d;
        const float ior = 1.0f + 1.6f * uniform(generator);
        cases.push_back({glm::vec4(d, i % 2 ? ior : 1.0f / ior), glm::vec4(n, 5.0f * uniform(generator))});
    }
    return cases;
}

using OpticsTwin = DeviceTest;

TEST_F(OpticsTwin, ShaderAgreesWithCpp) {
    const std::vector<Case> cases = random_cases(4096);
    const Buffer& input = workspace().buffer("cases", cases.size() * sizeof(Case), true);
    const Buffer& output = workspace().buffer("answers", cases.size() * sizeof(Answer), true);
    std::memcpy(input.mapped(), cases.data(), input.size());
    recorder().compute(workspace().compute(shaders::optics_twin_comp),
                       {reads("Cases", input), writes("Answers", output)}, {std::uint32_t(cases.size()), 1});
    recorder().submit_and_wait();
    const std::vector<Answer> answers = read_back<Answer>(output);

    int total_reflections = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const glm::vec3 d(cases[i].direction), n(cases[i].normal);
        const float eta = cases[i].direction.w;
        // At the critical angle itself rounding decides; a few parts in 10^7 around it are left out.
        if (std::abs(transmitted_cosine_squared(incident_cosine(d, n), eta)) < 1e-6f) continue;
        glm::vec3 refracted{};
        const bool passes = refract_direction(d, n, eta, refracted);
        total_reflections += passes ? 0 : 1;
        EXPECT_EQ(answers[i].refracted.w, passes ? 1.0f : 0.0f) << i;
        // Single precision on both sides; near grazing angles the square root magnifies one ulp to about 1e-4.
        if (passes) {
            EXPECT_LT(angle_deg(glm::vec3(answers[i].refracted), refracted), 0.05) << i;
        }
        EXPECT_LT(angle_deg(glm::vec3(answers[i].reflected), reflect_direction(d, n)), 0.01) << i;
        EXPECT_NEAR(answers[i].reflected.w, fresnel_dielectric(-glm::dot(d, n), eta), 2e-4) << i;
        const glm::vec3 left = beer_lambert(glm::abs(d), cases[i].normal.w);
        EXPECT_LT(glm::distance(left, glm::vec3(answers[i].transmitted)), 1e-5f) << i;
    }
    EXPECT_GT(total_reflections, 400);  // both branches were taken
}

}  // namespace
}  // namespace pellucid::test
