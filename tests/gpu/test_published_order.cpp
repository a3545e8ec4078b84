// What each publication added: the share of pixels that agree with exact ray tracing grows from one to the next.
#include "gpu/gpu_test.h"

#include <algorithm>

namespace pellucid::test {
namespace {

constexpr std::uint32_t kSize = 160;

class PublishedOrder : public RendererTest {
protected:
    std::vector<RefractedPath> paths(const char* technique) {
        RenderSettings settings;
        settings.width = settings.height = kSize;
        settings.technique = technique;
        settings.paths = true;
        return renderer().render(settings).paths;
    }
};

double within_1deg(const std::vector<RefractedPath>& paths, const std::vector<RefractedPath>& exact) {
    int covered = 0, right = 0;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (exact[i].events == 0) continue;
        ++covered;
        const bool done = paths[i].events > 0 && paths[i].status == Status::kOk;
        right += done && angle_deg(paths[i].direction, exact[i].direction) <= 1.0 ? 1 : 0;
    }
    return double(right) / std::max(covered, 1);
}

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

}  // namespace
}  // namespace pellucid::test
