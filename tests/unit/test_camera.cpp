#include <pellucid/error.h>
#include <pellucid/scene.h>

#include <gtest/gtest.h>

#include <cmath>

namespace pellucid {
namespace {

const Bounds kBounds{{1.0f, 2.0f, 3.0f}, 2.0f};
constexpr float kFov = 0.5f;

void expect_near(glm::vec3 a, glm::vec3 b) {
    EXPECT_LT(glm::length(a - b), 1e-5f) << a.x << " " << a.y << " " << a.z << " instead of " << b.x << " " << b.y
                                         << " " << b.z;
}

TEST(OrbitCamera, StandsWhereTheAnglesSay) {
    const auto eye = [](float azimuth, float elevation) {
        return glm::vec3(orbit_camera(kBounds, azimuth, elevation, 3.0f, kFov).world_from_view[3]);
    };
    expect_near(eye(0, 0), kBounds.center + glm::vec3(0, 0, 6));
    expect_near(eye(90, 0), kBounds.center + glm::vec3(6, 0, 0));
    expect_near(eye(180, 0), kBounds.center + glm::vec3(0, 0, -6));
    expect_near(eye(0, 90), kBounds.center + glm::vec3(0, 6, 0));
    expect_near(eye(0, -90), kBounds.center + glm::vec3(0, -6, 0));
}

TEST(OrbitCamera, LooksAtTheCentreAndStaysRigid) {
    for (const float azimuth : {0.0f, 37.0f, 90.0f, 200.0f, -75.0f}) {
        for (const float elevation : {-90.0f, -89.999f, -30.0f, 0.0f, 45.0f, 90.0f}) {
            const Camera camera = orbit_camera(kBounds, azimuth, elevation, 2.5f, kFov);
            const glm::mat4 m = camera.world_from_view;
            expect_near(glm::vec3(m * glm::vec4(0, 0, -2.5f * kBounds.radius, 1)), kBounds.center);
            const glm::mat3 rotation(m);
            const glm::mat3 unit = glm::transpose(rotation) * rotation;
            for (int k = 0; k < 3; ++k) EXPECT_LT(glm::length(unit[k] - glm::mat3(1.0f)[k]), 1e-6f);
            EXPECT_NEAR(glm::determinant(rotation), 1.0f, 1e-6f);
            EXPECT_GE(rotation[1].y, -1e-6f) << "the camera hangs upside down";
            EXPECT_EQ(camera.vertical_fov, kFov);
        }
    }
}

TEST(OrbitCamera, RefusesWhatIsNoView) {
    EXPECT_THROW(orbit_camera(kBounds, 0, 0, 1.0f, kFov), Error);
    EXPECT_THROW(orbit_camera(kBounds, 0, 91, 2.0f, kFov), Error);
    EXPECT_THROW(orbit_camera(kBounds, NAN, 0, 2.0f, kFov), Error);
    EXPECT_THROW(orbit_camera(kBounds, 0, NAN, 2.0f, kFov), Error);
    EXPECT_THROW(orbit_camera(kBounds, 0, 0, INFINITY, kFov), Error);
    EXPECT_THROW(orbit_camera(kBounds, 0, 0, 2.0f, 0.0f), Error);
    EXPECT_THROW(orbit_camera(kBounds, 0, 0, 2.0f, 3.2f), Error);
}

TEST(FramingDistance, RayToTheEdgeOfTheShareTouchesTheSphere) {
    for (const float fov : {0.05f, 0.5235988f, 1.5f, 3.0f}) {
        for (const float share : {0.01f, 0.5f, 0.9f, 0.999f}) {
            // Eye at distance d on the z axis; the ray through image height `share` passes the
            // centre of the unit sphere at distance d sin(angle).
            const double d = double(framing_distance(fov, share));
            const double angle = std::atan(double(share) * std::tan(0.5 * double(fov)));
            EXPECT_NEAR(d * std::sin(angle), 1.0, 1e-6) << "fov " << fov << " share " << share;
        }
    }
}

TEST(FramingDistance, RefusesSharesThatCannotBe) {
    EXPECT_THROW(framing_distance(kFov, 0.0f), Error);
    EXPECT_THROW(framing_distance(kFov, 1.0f), Error);
    EXPECT_THROW(framing_distance(kFov, NAN), Error);
    EXPECT_THROW(framing_distance(-1.0f, 0.5f), Error);
}

TEST(SceneBounds, HoldEveryVertexOfEveryPlacement) {
    Scene scene;
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    scene.meshes.push_back(mesh);
    Object object;
    scene.objects.push_back(object);
    object.world_from_object[3] = {10, 0, 0, 1};
    scene.objects.push_back(object);
    const Bounds bounds = scene_bounds(scene);
    expect_near(bounds.center, {5.5f, 0.5f, 0});
    EXPECT_NEAR(bounds.radius, std::hypot(5.5f, 0.5f), 1e-5f);
    EXPECT_EQ(scene.triangle_count(), 2u);
    EXPECT_EQ(scene_bounds(Scene()).radius, 0.0f);
}

TEST(Material, AbsorbsAsMuchAsItsAttenuationColourSays) {
    Material material;
    EXPECT_EQ(material.sigma_a(), glm::vec3(0.0f));
    material.attenuation_color = {0.5f, 1.0f, 0.0f};
    EXPECT_EQ(material.sigma_a(), glm::vec3(0.0f)) << "nothing is absorbed over an infinite distance";
    material.attenuation_distance = 2.0f;
    const glm::vec3 sigma_a = material.sigma_a();
    EXPECT_NEAR(std::exp(-sigma_a.x * 2.0f), 0.5f, 1e-6f);
    EXPECT_EQ(sigma_a.y, 0.0f);
    EXPECT_TRUE(std::isfinite(sigma_a.z));
    EXPECT_LT(std::exp(-sigma_a.z * 2.0f), 1e-20f);
}

}  // namespace
}  // namespace pellucid
