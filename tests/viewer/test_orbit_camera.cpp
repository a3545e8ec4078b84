#include "viewer/orbit_camera.h"

#include "options/arguments.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace pellucid::viewer {
namespace {

const Bounds kBounds{{1.0f, 2.0f, 3.0f}, 0.7f, {0.4f, 0.4f, 0.4f}};

glm::vec3 eye(const OrbitCamera& orbit) { return camera_of(orbit, kBounds).world_from_view[3]; }
glm::vec3 forward(const OrbitCamera& orbit) { return -glm::vec3(camera_of(orbit, kBounds).world_from_view[2]); }

TEST(OrbitCamera, FramesAsRenderDoes) {
    for (const auto& [width, height] : {std::pair{640u, 360u}, std::pair{360u, 640u}}) {
        const Camera ours = camera_of(framing_orbit(kBounds, width, height), kBounds);
        const Camera theirs = framing_camera(kBounds, width, height, glm::radians(30.0f));
        for (int column = 0; column < 4; ++column)
            EXPECT_LT(glm::distance(ours.world_from_view[column], theirs.world_from_view[column]), 1e-5f);
    }
}

TEST(OrbitCamera, EqualsTheCameraOfTheLibraryBitForBit) {
    const OrbitCamera orbit{kBounds.center, 33.3f, -12.7f, 3.1f, 41.0f};
    const Camera camera = orbit_camera(kBounds, 33.3f, -12.7f, 3.1f, glm::radians(41.0f));
    EXPECT_EQ(camera_of(orbit, kBounds).world_from_view, camera.world_from_view);
    EXPECT_EQ(camera_of(orbit, kBounds).vertical_fov, camera.vertical_fov);
}

TEST(OrbitCamera, ComesBackFromACamera) {
    const OrbitCamera orbit{kBounds.center, -120.0f, 40.0f, 2.5f, 35.0f};
    const OrbitCamera back = orbit_from_camera(camera_of(orbit, kBounds), kBounds);
    EXPECT_NEAR(back.azimuth_deg, orbit.azimuth_deg, 1e-3f);
    EXPECT_NEAR(back.elevation_deg, orbit.elevation_deg, 1e-3f);
    EXPECT_NEAR(back.distance, orbit.distance, 1e-4f);
    EXPECT_NEAR(back.fov_deg, orbit.fov_deg, 1e-4f);
    EXPECT_LT(glm::distance(back.target, orbit.target), 1e-4f);
}

TEST(OrbitCamera, StopsAtThePoles) {
    OrbitCamera orbit;
    turn(orbit, 350.0f, 100.0f);
    EXPECT_FLOAT_EQ(orbit.azimuth_deg, -10.0f);
    EXPECT_FLOAT_EQ(orbit.elevation_deg, 90.0f);
    EXPECT_NO_THROW(camera_of(orbit, kBounds));
}

TEST(OrbitCamera, MayComeNearerThanARadius) {
    OrbitCamera orbit{kBounds.center, 0.0f, 0.0f, 2.0f, 30.0f};
    for (int i = 0; i < 100; ++i) zoom(orbit, 1.5f);
    EXPECT_GT(orbit.distance, 0.0f);
    EXPECT_LT(glm::distance(eye(orbit), kBounds.center), 0.1f * kBounds.radius);
}

TEST(OrbitCamera, PanMovesTheTargetWithTheImage) {
    OrbitCamera orbit{kBounds.center, 20.0f, 30.0f, 3.0f, 30.0f};
    const Camera before = camera_of(orbit, kBounds);
    pan(orbit, kBounds, 0.25f, 0.0f);
    // The old target now lies a quarter of the height right of the middle.
    const glm::vec3 view = glm::inverse(camera_of(orbit, kBounds).world_from_view) * glm::vec4(kBounds.center, 1.0f);
    const float half = std::tan(glm::radians(15.0f)) * -view.z;
    EXPECT_NEAR(view.x / (2.0f * half), 0.25f, 1e-4f);
    EXPECT_NEAR(view.y, 0.0f, 1e-5f);
    EXPECT_LT(glm::distance(glm::vec3(before.world_from_view[2]), -forward(orbit)), 1e-6f);
}

TEST(OrbitCamera, LooksAroundWhereItStands) {
    OrbitCamera orbit{kBounds.center, 20.0f, 30.0f, 3.0f, 30.0f};
    const glm::vec3 before = eye(orbit);
    look_around(orbit, kBounds, 15.0f, -10.0f);
    EXPECT_LT(glm::distance(before, eye(orbit)), 1e-5f);
}

TEST(OrbitCamera, FliesForward) {
    OrbitCamera orbit{kBounds.center, 20.0f, 30.0f, 3.0f, 30.0f};
    const glm::vec3 before = eye(orbit), way = forward(orbit);
    fly(orbit, kBounds, {0.0f, 0.0f, 1.0f});
    EXPECT_LT(glm::distance(before + kBounds.radius * way, eye(orbit)), 1e-5f);
}

TEST(OrbitCamera, IsACameraOfTheCommandLine) {
    const Scene scene = load_scene("shape:sphere");
    const Bounds bounds = scene_bounds(scene);
    const OrbitCamera orbit{{0.25f, -0.125f, 0.1f}, 33.3f, -12.7f, 0.6f, 30.0f};
    const Camera typed = cli::parse_camera("orbit:33.3,-12.7,0.6,0.25,-0.125,0.1", scene, glm::radians(30.0f));
    EXPECT_EQ(typed.world_from_view, camera_of(orbit, bounds).world_from_view);
}

}  // namespace
}  // namespace pellucid::viewer
