// The two truths of translucency: rays through triangles by Embree, and a ray march of distance fields.
#include <pellucid/pellucid.h>
#include <pellucid/thickness.h>

#include <gtest/gtest.h>

#include <vector>

namespace pellucid {
namespace {

TEST(ExactThickness, MarchedThroughThreeBallsLeavesTheGapsOut) {
    const DistanceField balls = distance_to({{{0.0, 0.2, 4.0}, 0.3}, {{0.0, 0.2, 3.2}, 0.3}, {{0.0, 0.2, 2.4}, 0.3}});
    EXPECT_NEAR(marched_thickness(balls, {0.0, 0.2, 5.0}, {0.0, 0.2, 2.0}, 1e-9), 1.8, 1e-6);
    EXPECT_NEAR(marched_thickness(balls, {0.0, 0.2, 5.0}, {0.0, 0.2, 3.2}, 1e-9), 0.9, 1e-6);
    EXPECT_NEAR(marched_thickness(balls, {1.0, 0.2, 5.0}, {1.0, 0.2, 2.0}, 1e-9), 0.0, 1e-6);
}

// A ball of 131,072 triangles lies within 2e-5 radii of the round one; the rest are pixels of the silhouette.
TEST(ExactThickness, RaysThroughTrianglesAgreeWithTheMarch) {
    LoadOptions options;
    options.translucent = Translucency{glm::vec3(0.5f), 1.0f};
    Scene scene = load_scene("shape:sphere,segments=128", options);
    Light light;
    light.kind = Light::Kind::kDirectional;
    light.direction = glm::normalize(glm::vec3(0.3f, -0.2f, 1.0f));
    scene.lights.push_back(light);
    const Bounds bounds = scene_bounds(scene);
    const Camera camera = framing_camera(bounds, 64, 64, Camera{}.vertical_fov);
    const Image traced = ThicknessTracer(scene, 2).trace(camera, 64, 64, 0);
    const Image marched =
        march_thickness(distance_to({Ball{}}), bounds, camera, 64, 64, glm::dvec3(light.direction), 2);
    const ThicknessError error = thickness_error(marched, traced);
    EXPECT_GT(error.points, 500u);
    EXPECT_LT(error.relative, 0.005);
}

}  // namespace
}  // namespace pellucid
