// The tracer for timing against the exact one.

#include "traced_scenes.h"

#include <pellucid/error.h>
#include <pellucid/reference.h>

#include <gtest/gtest.h>

namespace pellucid {
namespace {

using namespace test;

std::vector<glm::vec3> trace_fast(const Tracer& tracer, const Camera& camera, const ExactSettings& settings) {
    std::vector<glm::vec3> directions(std::size_t(settings.width) * settings.height);
    tracer.trace_fast(camera, settings, directions);
    return directions;
}

/// Share of pixels whose directions are less than a degree apart.
double agreement(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
    std::size_t close = 0;
    for (std::size_t i = 0; i < a.size(); ++i) close += angle_deg(a[i], b[i]) < 1.0;
    return double(close) / double(a.size());
}

std::vector<glm::vec3> exact_directions(const Tracer& tracer, const Camera& camera, const ExactSettings& settings) {
    std::vector<glm::vec3> directions;
    for (const RefractedPath& path : tracer.exact(camera, settings)) directions.push_back(path.direction);
    return directions;
}

TEST(FloatTrace, AgreesWithTheExactTracer) {
    for (const char* shape : {"shape:sphere", "shape:torus", "shape:knot"}) {
        const Scene scene = load_scene(shape);
        const Camera camera = view_of(scene, 20.0f);
        const Tracer tracer(scene);
        ExactSettings settings{.width = 203, .height = 131, .shift_px = {0.2, -0.3}};  // no multiples of a tile
        const std::vector<glm::vec3> exact = exact_directions(tracer, camera, settings);
        const std::vector<glm::vec3> single = trace_fast(tracer, camera, settings);
        for (const std::uint32_t packet : {1u, 4u, 8u, 16u}) {
            settings.packet = packet;
            const std::vector<glm::vec3> directions = trace_fast(tracer, camera, settings);
            EXPECT_GE(agreement(exact, directions), 0.995) << shape << ", packet " << packet;
            EXPECT_GE(agreement(single, directions), 0.999) << shape << ", packet " << packet;
        }
    }
}

TEST(FloatTrace, CutsPathsWhereTheExactTracerDoes) {
    const Scene scene = load_scene("shape:knot");
    const Camera camera = view_of(scene, 0.0f);
    const Tracer tracer(scene);
    for (const std::uint32_t max_events : {1u, 3u}) {
        const ExactSettings settings{.width = 128, .height = 128, .max_events = max_events};
        EXPECT_GE(agreement(exact_directions(tracer, camera, settings), trace_fast(tracer, camera, settings)), 0.995);
    }
}

TEST(FloatTrace, KnowsCamerasAndMedia) {
    Scene scene = load_scene("shape:sphere");
    const Tracer sphere(scene);
    const ExactSettings settings{.width = 64, .height = 64};
    Camera parallel = parallel_camera(glm::vec3(0.0f), glm::normalize(glm::vec3(0.2f, -0.3f, -1.0f)), 2.5f);
    const auto agreement_of = [&](const Tracer& tracer, const Camera& camera) {
        return agreement(exact_directions(tracer, camera, settings), trace_fast(tracer, camera, settings));
    };
    EXPECT_GE(agreement_of(sphere, parallel), 0.99);
    parallel.near_plane = 9.5f;  // a slice through the sphere: some rays start inside
    EXPECT_GE(agreement_of(sphere, parallel), 0.99);
    Camera inside = view_of(scene, 0.0f);
    inside.world_from_view[3] = glm::vec4(0.1f, 0.2f, 0.3f, 1.0f);
    EXPECT_GE(agreement_of(sphere, inside), 0.99);
    // Liquid in a glass, and a surface of two shells.
    for (const char* shape : {"shape:goblet", "shape:hollow-sphere"}) {
        const Scene nested = load_scene(shape);
        EXPECT_GE(agreement_of(Tracer(nested), view_of(nested, 0.0f)), 0.98) << shape;
    }
}

TEST(FloatTrace, OpaqueEndsThePathAndPanesDoNotBendIt) {
    Scene scene;
    Material pane = glass();
    pane.thickness = 0.0f;
    add(scene, square(), pane, glm::translate(glm::mat4(1.0f), {0.0f, 0.0f, 2.0f}));
    add(scene, load_scene("shape:sphere").meshes[0], glass(), glm::scale(glm::mat4(1.0f), glm::vec3(0.7f)));
    add(scene, square(), Material{}, glm::translate(glm::mat4(1.0f), {0.5f, 0.0f, -2.0f}));
    const Tracer tracer(scene);
    const Camera camera = parallel_camera(glm::vec3(0.0f), {0, 0, -1}, 2.0f);
    const ExactSettings settings{.width = 64, .height = 64};
    EXPECT_GE(agreement(exact_directions(tracer, camera, settings), trace_fast(tracer, camera, settings)), 0.99);
}

TEST(FloatTrace, RefusesWhatItCannotTrace) {
    const Scene scene = load_scene("shape:cube");
    const Tracer tracer(scene);
    const Camera camera = view_of(scene, 0.0f);
    std::vector<glm::vec3> directions(64);
    EXPECT_NO_THROW(tracer.trace_fast(camera, {.width = 8, .height = 8}, directions));
    EXPECT_THROW(tracer.trace_fast(camera, {.width = 8, .height = 7}, directions), Error);
    EXPECT_THROW(tracer.trace_fast(camera, {.width = 8, .height = 8, .packet = 3}, directions), Error);
    Camera flat = camera;
    flat.vertical_fov = 0.0f;
    EXPECT_THROW(tracer.trace_fast(flat, {.width = 8, .height = 8}, directions), Error);
}

}  // namespace
}  // namespace pellucid
