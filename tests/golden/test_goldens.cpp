// Pictures against stored ones, to notice changes that no other test looks for. After an intended
// change run with PELLUCID_UPDATE_GOLDENS=1, and look at what it wrote before committing it.
#include "gpu/gpu_test.h"

#include <glm/gtx/rotate_vector.hpp>

#include <filesystem>

namespace pellucid::test {
namespace {

/// Two solids of different glass, one of them coloured, before painted boards.
Scene still_life() {
    Scene scene = load_scene("shape:goblet");
    const auto add = [&](const char* shape, const Material& material, glm::vec3 place, float scale) {
        Object object;
        object.mesh = int(scene.meshes.size());
        object.material = int(scene.materials.size());
        object.world_from_object = glm::scale(glm::translate(glm::mat4(1.0f), place), glm::vec3(scale));
        scene.meshes.push_back(load_scene(shape).meshes.front());
        scene.materials.push_back(material);
        scene.objects.push_back(object);
    };
    Material amber = scene.materials.front(), red, green;
    amber.ior = 1.33f;
    amber.attenuation_color = {0.9f, 0.5f, 0.1f};
    amber.attenuation_distance = 0.5f;
    red.base_color = {0.8f, 0.1f, 0.1f, 1.0f};
    green.base_color = {0.1f, 0.6f, 0.2f, 1.0f};
    add("shape:sphere", amber, {0.9f, -0.4f, 0.2f}, 0.45f);
    add("shape:cube", red, {-0.9f, 0.0f, -1.5f}, 0.6f);
    add("shape:sphere", green, {0.3f, 0.1f, 0.0f}, 0.15f);
    return scene;
}

Scene lit_wax() {
    Scene scene = load_scene("shape:knot");
    make_translucent(scene, {.color = {0.8f, 0.4f, 0.2f}, .distance = 0.3f});
    Light light;
    light.kind = Light::Kind::kDirectional;
    light.intensity = glm::vec3(4.0f);
    light.direction = glm::normalize(glm::vec3(-0.3f, -0.4f, 1.0f));
    scene.lights.push_back(light);
    return scene;
}

struct Golden {
    const char* name;
    Scene (*scene)();
    const char* environment;
    const char* technique;
    View view = View::kRadiance;
    bool moves =
        false;  ///< a frame is drawn, and then the vertices of the first mesh are turned the more the higher they lie
};

std::vector<MovedMesh> twisted(const Mesh& mesh, std::vector<glm::vec3>& positions, std::vector<glm::vec3>& normals) {
    positions.clear(), normals.clear();
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const float angle = 1.2f * mesh.positions[i].y;
        positions.push_back(glm::rotateY(mesh.positions[i], angle));
        normals.push_back(glm::rotateY(mesh.normals[i], angle));  // nearly: the twist also leans them
    }
    return {{0, positions, normals}};
}

class Goldens : public RendererTest, public ::testing::WithParamInterface<Golden> {};

TEST_P(Goldens, PictureIsUnchanged) {
    const Golden& golden = GetParam();
    const Scene scene = golden.scene();
    renderer().set_scene(scene);
    renderer().set_environment(load_environment(golden.environment));
    RenderSettings settings;
    settings.width = settings.height = 128;
    settings.samples = 4;
    settings.technique = golden.technique;
    settings.view = golden.view;
    std::vector<glm::vec3> positions, normals;
    if (golden.moves) {
        renderer().render(settings);
        renderer().set_positions(twisted(scene.meshes.front(), positions, normals));
    }
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

Scene goblet() { return load_scene("shape:goblet"); }
Scene knot() { return load_scene("shape:knot"); }
Scene gem() { return load_scene("shape:gem"); }
Scene lens() { return load_scene("volume:smoothed-sphere,resolution=48"); }

INSTANTIATE_TEST_SUITE_P(All, Goldens,
                         ::testing::Values(Golden{"goblet_one_interface", goblet, "studio", "one-interface"},
                                           Golden{"goblet_wang_2014", goblet, "studio", "wang-2014"},
                                           Golden{"knot_wang_2014", knot, "sky", "wang-2014"},
                                           Golden{"gem_wang_2014", gem, "checker", "wang-2014"},
                                           Golden{"knot_analysis", knot, "studio", "wang-2014", View::kAnalysis},
                                           Golden{"still_life_balanced", still_life, "sky", "balanced"},
                                           Golden{"moved_knot_balanced", knot, "sky", "balanced", View::kRadiance,
                                                  true},
                                           Golden{"wax_balanced", lit_wax, "studio", "balanced"},
                                           Golden{"volume_balanced", lens, "checker", "balanced"}),
                         [](const auto& golden) { return std::string(golden.param.name); });

}  // namespace
}  // namespace pellucid::test
