// What a picture says of the light that it leaves out.
#include "render/approximations.h"

#include "built_scenes.h"
#include "built_volumes.h"
#include "closed_form/lights.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace pellucid {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> of_lights(const Scene& scene, LightTransport transport,
                                   const char* technique = "visibility-layers") {
    LightOptions light;
    light.transport = transport;
    return approximations(scene, find_technique(technique), light, false);
}

TEST(Approximations, LightsWithASizeAreSeenThoughNothingIsLit) {
    Scene scene = scene_of(with_flat_normals(cube()), glass());
    scene.lights = {lamp({0, 3, 0}, 1.0f, 0.2f)};
    EXPECT_THAT(of_lights(scene, LightTransport::kDirect), IsEmpty());
    EXPECT_THAT(of_lights(scene, LightTransport::kEnvironment), ElementsAre("1 light is not drawn"));
    scene.lights.push_back(lamp({0, 3, 0}, 1.0f));
    scene.lights.push_back(sun({0, -1, 0}, 1.0f));
    EXPECT_THAT(of_lights(scene, LightTransport::kDirect), ElementsAre("2 lights without a size are not drawn"));
    EXPECT_THAT(of_lights(scene, LightTransport::kEnvironment), ElementsAre("3 lights are not drawn"));
    scene.materials[0].roughness = 0.3f;
    EXPECT_THAT(of_lights(scene, LightTransport::kDirect), IsEmpty());
}

TEST(Approximations, TheTruthLosesScatteredLightOfVolumesAlone) {
    Scene scene = scene_of(with_flat_normals(cube()), glass());
    scene.lights = {sun({0, -1, 0}, 1.0f)};
    Volume volume = even(glm::vec3(1.0f), glm::vec3(0.0f));
    add_volume(scene, volume);
    EXPECT_THAT(of_lights(scene, LightTransport::kAutomatic, "path"), IsEmpty());
    volume.sigma_s.assign(volume.voxel_count(), glm::vec3(1.0f));
    add_volume(scene, volume);
    EXPECT_THAT(of_lights(scene, LightTransport::kAutomatic, "path"),
                ElementsAre("light that volumes scatter is lost"));
}

}  // namespace
}  // namespace pellucid
