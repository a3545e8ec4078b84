// Pictures against stored ones, to notice changes that no other test looks for. After an intended
// change run with PELLUCID_UPDATE_GOLDENS=1, and look at what it wrote before committing it.
#include "gpu/gpu_test.h"

#include <filesystem>

namespace pellucid::test {
namespace {

struct Golden {
    const char* name;
    const char* scene;
    const char* environment;
    const char* technique;
    View view;
};

class Goldens : public RendererTest, public ::testing::WithParamInterface<Golden> {};

TEST_P(Goldens, PictureIsUnchanged) {
    const Golden& golden = GetParam();
    renderer().set_scene(load_scene(golden.scene));
    renderer().set_environment(load_environment(golden.environment));
    RenderSettings settings;
    settings.width = settings.height = 128;
    settings.samples = 4;
    settings.technique = golden.technique;
    settings.view = golden.view;
    const Image picture = renderer().render(settings).display;

    const std::filesystem::path file =
        std::filesystem::path(PELLUCID_GOLDEN_FOLDER) / (std::string(golden.name) + ".png");
    if (std::getenv("PELLUCID_UPDATE_GOLDENS")) write_image(file, picture);
    const Image expected = read_image(file);
    ASSERT_EQ(picture.pixels.size(), expected.pixels.size());
    double sum = 0.0;
    std::size_t different = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const double difference = std::abs(double(picture.pixels[i]) - double(expected.pixels[i]));
        sum += difference;
        different += difference > 16.0 / 255.0 ? 1 : 0;
    }
    // Devices round differently: coverage at silhouettes and texels under a search step flip. That
    // changes single pixels by much; a change of the method changes many.
    EXPECT_LT(sum / double(picture.pixels.size()), 0.5 / 255.0);
    EXPECT_LT(double(different) / double(picture.pixels.size()), 0.01);
}

INSTANTIATE_TEST_SUITE_P(
    All, Goldens,
    ::testing::Values(Golden{"goblet_one_interface", "shape:goblet", "studio", "one-interface", View::kRadiance},
                      Golden{"goblet_wang_2014", "shape:goblet", "studio", "wang-2014", View::kRadiance},
                      Golden{"knot_wang_2014", "shape:knot", "sky", "wang-2014", View::kRadiance},
                      Golden{"gem_wang_2014", "shape:gem", "checker", "wang-2014", View::kRadiance},
                      Golden{"knot_analysis", "shape:knot", "studio", "wang-2014", View::kAnalysis}),
    [](const auto& golden) { return std::string(golden.param.name); });

}  // namespace
}  // namespace pellucid::test
