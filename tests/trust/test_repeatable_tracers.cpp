// The CPU tracers give the same paths and images bit for bit on any number of threads.
#include "trust/trust_scenes.h"
#include "unit/traced_scenes.h"

#include <pellucid/path_surfaces.h>

#include <gtest/gtest.h>

namespace pellucid::test {
namespace {

TEST(RepeatableTracers, OnAnyNumberOfThreads) {
    for (const Scene& scene : {table_scene(), crowd_scene(), load_scene("shape:knot")}) {
        const Camera camera = view_of(scene, 20);
        const ExactSettings settings{.width = 93, .height = 71};
        PathTraceSettings sampled;
        sampled.width = 33;
        sampled.height = 29;
        sampled.samples = 3;
        sampled.photons = 500;
        const Environment environment = load_environment("studio");
        std::vector<RefractedPath> exact;
        std::vector<float> traced;
        for (const std::uint32_t threads : {1u, 2u, 5u, 5u, 5u, 0u}) {
            SCOPED_TRACE(threads);
            const Tracer tracer(scene, {.threads = threads});
            std::vector<RefractedPath> paths = tracer.exact(camera, settings);
            std::vector<float> pixels = tracer.path_trace(camera, environment, sampled).radiance.pixels;
            if (exact.empty()) {
                exact = paths;
                traced = pixels;
            }
            EXPECT_EQ(count_different(exact, paths), 0u);
            EXPECT_EQ(traced, pixels);
            const std::vector<SurfacePath> surfaces = SurfaceTracer(scene, threads).trace(camera, settings);
            for (std::size_t i = 0; i < surfaces.size(); ++i) paths[i] = surfaces[i].path;
            EXPECT_EQ(count_different(exact, paths), 0u) << "with surfaces";
        }
    }
}

}  // namespace
}  // namespace pellucid::test
