#pragma once

// Tests that draw: on the best device there is, with core and synchronisation validation. One
// message of the validation layer fails the test. Where there is no device they skip, saying why.
#include <pellucid/pellucid.h>

#include "core/math.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

namespace pellucid::test {

inline void expect_silent(const std::vector<std::string>& messages) {
    EXPECT_TRUE(messages.empty()) << messages.size() << " validation messages, the first: " << messages.front();
}

class RendererTest : public ::testing::Test {
protected:
    void SetUp() override {
        try {
            renderer_.emplace(DeviceOptions{.device = {}, .validation = true});
        } catch (const DeviceError& error) {
            GTEST_SKIP() << error.what();
        }
    }
    void TearDown() override {
        if (renderer_) expect_silent(renderer_->validation_messages());
    }
    Renderer& renderer() { return *renderer_; }

private:
    std::optional<Renderer> renderer_;
};

/// Tests of what holds for several techniques; each skips what the device lacks for one.
class TechniqueTest : public RendererTest, public ::testing::WithParamInterface<const char*> {
protected:
    void SetUp() override {
        RendererTest::SetUp();
        if (IsSkipped()) return;
        if (const std::string lacking = renderer().lacking(find_technique(GetParam())); !lacking.empty())
            GTEST_SKIP() << "the device lacks " << lacking;
    }
};

/// The technique's name as a test's.
inline std::string technique_test_name(const ::testing::TestParamInfo<const char*>& info) {
    std::string name = info.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

/// All AOVs but the parts of the light, for which every frame is drawn once more.
inline std::vector<std::string> aovs_of_paths() {
    std::vector<std::string> names;
    for (const AovInfo& aov : aov_infos()) {
        const bool light = std::find(kLightParts.begin(), kLightParts.end(), aov.name) != kLightParts.end();
        if (!light) names.emplace_back(aov.name);
    }
    return names;
}

inline Environment uniform_environment(glm::vec3 radiance = glm::vec3(1.0f)) {
    Environment environment;
    environment.kind = Environment::Kind::kUniform;
    environment.uniform_radiance = radiance;
    return environment;
}

inline glm::vec3 rgb(const Image& image, int x, int y) {
    const float* p = image.at(x, y);
    if (image.channels == 1) return glm::vec3(p[0]);
    return image.channels == 2 ? glm::vec3(p[0], p[1], 0.0f) : glm::vec3(p[0], p[1], p[2]);
}

/// Degrees between two directions; robust for small angles. A zero vector is 180 degrees off.
inline double angle_deg(glm::dvec3 a, glm::dvec3 b) {
    if (glm::length(a) == 0.0 || glm::length(b) == 0.0) return 180.0;
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 57.29577951308232;
}

/// Share of the pixels with glass on which paths that were followed to their end agree with exact ones to a degree.
inline double within_1deg(const std::vector<RefractedPath>& paths, const std::vector<RefractedPath>& exact) {
    int covered = 0, right = 0;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (exact[i].events == 0) continue;
        ++covered;
        const bool done = paths[i].events > 0 && paths[i].status == Status::kOk;
        right += done && angle_deg(paths[i].direction, exact[i].direction) <= 1.0 ? 1 : 0;
    }
    return double(right) / std::max(covered, 1);
}

/// Bit for bit.
inline bool same_paths(const std::vector<RefractedPath>& a, const std::vector<RefractedPath>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const RefractedPath& p, const RefractedPath& q) {
        return p.direction == q.direction && p.position == q.position && p.transmittance == q.transmittance &&
               p.length_inside == q.length_inside && p.events == q.events && p.reflections == q.reflections &&
               p.status == q.status && p.object == q.object;
    });
}

inline bool all_finite(const Image& image) {
    for (const float value : image.pixels) {
        if (!std::isfinite(value)) return false;
    }
    return true;
}

/// World ray through a pixel centre of a perspective camera, in double precision.
struct WorldRay {
    glm::dvec3 origin, direction;
};
inline WorldRay pixel_ray(const Camera& camera, int width, int height, double x, double y) {
    const double pixel = 2.0 * std::tan(0.5 * double(camera.vertical_fov)) / height;
    const glm::dvec3 view((x + 0.5 - 0.5 * width) * pixel, (0.5 * height - y - 0.5) * pixel, -1.0);
    const glm::dmat4 world(camera.world_from_view);
    return {glm::dvec3(world[3]), glm::normalize(glm::dmat3(world) * view)};
}

}  // namespace pellucid::test
