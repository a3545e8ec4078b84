// What each publication added: the share of pixels that agree with exact ray tracing grows from one to the next.
#include "gpu/gpu_test.h"

namespace pellucid::test {
namespace {

constexpr std::uint32_t kSize = 192;

class PublishedOrder : public RendererTest {
protected:
    std::vector<RefractedPath> paths(const char* technique, const ParameterMap& parameters = {}) {
        RenderSettings settings;
        settings.parameters = parameters;
        settings.width = settings.height = kSize;
        settings.technique = technique;
        settings.paths = true;
        return renderer().render(settings).paths;
    }
};

TEST_F(PublishedOrder, EveryStepIsMoreAccurateInTheMean) {
    const std::vector<const char*> order = {"one-interface", "wyman-2005", "oliveira-brauwers-2007", "wang-2014"};
    const std::vector<const char*> shapes = {"shape:sphere", "shape:torus",  "shape:knot",
                                             "shape:goblet", "shape:bottle", "shape:infinity-ring"};
    std::vector<double> mean(order.size(), 0.0);
    for (const char* shape : shapes) {
        renderer().set_scene(load_scene(shape));
        const std::vector<RefractedPath> exact = paths("reference");
        for (std::size_t i = 0; i < order.size(); ++i) {
            mean[i] += within_1deg(paths(order[i]), exact) / double(shapes.size());
        }
    }
    for (std::size_t i = 1; i < order.size(); ++i) EXPECT_GT(mean[i], mean[i - 1] + 0.05) << order[i];
}

// Thesis, section 5.2, and our choices beyond it: each finds exits that the others do not find.
TEST_F(PublishedOrder, EveryKindOfExitOfWang2014IsFound) {
    const auto right = [&](const char* shape, double below_faults, double front_exits, double steep_walls) {
        const Scene scene = load_scene(shape);
        renderer().set_scene(scene);
        const float fov = Camera().vertical_fov;
        renderer().set_camera(orbit_camera(scene_bounds(scene), 90.0f, 15.0f, framing_distance(fov, 0.7f), fov));
        return within_1deg(
            paths("wang-2014",
                  {{"below-faults", below_faults}, {"front-exits", front_exits}, {"steep-walls", steep_walls}}),
            paths("reference"));
    };
    EXPECT_GT(right("shape:torus", 1, 0, 0), right("shape:torus", 0, 0, 0) + 0.05);
    EXPECT_GT(right("shape:hollow-sphere", 1, 1, 1), right("shape:hollow-sphere", 1, 0, 1) + 0.02);
    EXPECT_GT(right("shape:goblet", 0, 0, 1), right("shape:goblet", 0, 0, 0) + 0.02);
}

}  // namespace
}  // namespace pellucid::test
