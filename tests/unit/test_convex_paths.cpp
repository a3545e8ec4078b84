// Wang, "Image Space Real-time Multi-refraction Technology", 2014, section 3.1: a convex object never needs more
// than two interfaces, total reflection aside. Holds where normals are those of the faces.
#include "traced_scenes.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace pellucid {
namespace {

using namespace test;

struct Counts {
    std::size_t covered = 0, reflected = 0, two = 0;
    std::size_t other() const { return covered - reflected - two; }
};

/// Paths of random views, some from close by, some with parallel rays.
Counts count_paths(const Scene& scene) {
    const Tracer tracer(scene);
    const Bounds bounds = scene_bounds(scene);
    std::mt19937 random(20141107);
    const auto uniform = [&](float low, float high) { return low + (high - low) * float(random()) / 4294967296.0f; };
    ExactSettings settings;
    settings.width = settings.height = 64;
    Counts counts;
    for (int view = 0; view < 40; ++view) {
        Camera camera = orbit_camera(bounds, uniform(0, 360), uniform(-85, 85), uniform(1.2f, 8.0f), 0.8f);
        camera.orthographic = view % 4 == 0;
        camera.vertical_extent = 2.0f * bounds.radius;
        for (const RefractedPath& path : tracer.exact(camera, settings)) {
            if (path.events == 0) continue;
            ++counts.covered;
            if (path.reflections > 0)
                ++counts.reflected;
            else if (path.events == 2 && path.status == Status::kOk)
                ++counts.two;
        }
    }
    return counts;
}

Scene flat(const std::string& shape) {
    Scene scene = load_scene(shape);
    scene.meshes[0] = with_flat_normals(scene.meshes[0]);
    return scene;
}

TEST(ConvexPaths, HaveTwoInterfacesUnlessTotallyReflected) {
    for (const char* shape : {"shape:cube", "shape:slab", "shape:gem", "shape:sphere,segments=4",
                              "shape:sphere,segments=6", "shape:sphere,segments=12"}) {
        for (const float ior : {1.1f, 1.5f, 2.4f}) {
            Scene scene = flat(shape);
            scene.materials[0].ior = ior;
            const Counts counts = count_paths(scene);
            EXPECT_GT(counts.two, 1000u) << shape << " " << ior;
            EXPECT_EQ(counts.other(), 0u) << shape << " " << ior << ": of " << counts.covered;
        }
    }
    EXPECT_EQ(count_paths(scene_of(prism({-1, 0}, {1, 0}, {0, 1.7f}))).other(), 0u);
}

TEST(ConvexPaths, ConcaveObjectsNeedMore) {
    for (const char* shape : {"shape:torus", "shape:goblet", "shape:hollow-sphere"}) {
        const Counts counts = count_paths(flat(shape));
        EXPECT_GT(counts.other(), counts.covered / 50) << shape;
    }
}

}  // namespace
}  // namespace pellucid
