// Every technique on every real model there is: open meshes, inverted ones, scans, whole glTF scenes.
#include "gpu/gpu_test.h"
#include "unit/test_files.h"

#include <algorithm>
#include <cstring>

namespace pellucid::test {
namespace {

std::vector<std::string> model_files() {
    std::vector<std::string> files;
    if (data_folder().empty()) return files;
    for (const char* folder : {"models", "gltf"}) {
        for (const auto& entry : std::filesystem::recursive_directory_iterator(data_folder() / folder)) {
            const std::string extension = entry.path().extension();
            const bool model = extension == ".obj" || extension == ".ply" || extension == ".off" ||
                               extension == ".gltf" || extension == ".glb";
            if (entry.is_regular_file() && model) files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

class EveryModel : public RendererTest, public ::testing::WithParamInterface<std::string> {
protected:
    RenderResult render(const std::string& technique) {
        RenderSettings settings;
        settings.width = 96;
        settings.height = 80;
        settings.technique = technique;
        settings.paths = true;
        settings.aovs = {"layers"};
        return renderer().render(settings);
    }
};

/// `smoothed`: surfaces are blurred, so that rays that miss them may bend and thin walls may vanish.
void expect_sound(const RenderResult& result, bool smoothed) {
    EXPECT_TRUE(all_finite(result.radiance));
    const std::vector<float>& layers = result.aovs.at("layers").pixels;
    for (std::size_t i = 0; i < result.paths.size(); ++i) {
        const RefractedPath& path = result.paths[i];
        // A pixel that has layers and no events is one that the technique left untouched.
        if (!smoothed) {
            ASSERT_EQ(path.events > 0, layers[i] > 0.0f) << "pixel " << i;
        }
        ASSERT_LT(std::uint32_t(path.status), kStatusCount) << "pixel " << i;
        ASSERT_NEAR(glm::length(path.direction), 1.0f, 1e-3f) << "pixel " << i;
        for (int c = 0; c < 3; ++c) {
            ASSERT_TRUE(std::isfinite(path.position[c])) << "pixel " << i;
            ASSERT_GE(path.transmittance[c], 0.0f) << "pixel " << i;
            ASSERT_LE(path.transmittance[c], 1.0f) << "pixel " << i;
        }
        ASSERT_GE(path.length_inside, 0.0f) << "pixel " << i;
    }
}

TEST_P(EveryModel, IsDrawnSoundlyAndTheSameTwice) {
    std::optional<Scene> scene;
    try {
        scene = load_scene(GetParam());
    } catch (const Error& error) {
        GTEST_SKIP() << error.what();
    }
    renderer().set_scene(*scene);
    for (const TechniqueInfo* technique : techniques()) {
        if (technique->reference || !renderer().lacking(*technique).empty()) continue;
        SCOPED_TRACE(technique->name);
        const RenderResult result = render(std::string(technique->name));
        expect_sound(result, technique->volumes);
        const RenderResult again = render(std::string(technique->name));
        EXPECT_TRUE(same_paths(result.paths, again.paths));
        EXPECT_EQ(result.radiance.pixels, again.radiance.pixels);
    }
}

std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
    std::string name = std::filesystem::path(info.param).filename();
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return name + "_" + std::to_string(info.index);
}

INSTANTIATE_TEST_SUITE_P(All, EveryModel, ::testing::ValuesIn(model_files()), test_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(EveryModel);

}  // namespace
}  // namespace pellucid::test
