// Volumes that nodes of glTF files name: where they stand and what for.
#include "gltf_builder.h"
#include "scene/check_scene.h"
#include "test_files.h"

#include <gtest/gtest.h>

namespace pellucid {
namespace {

using namespace test;

constexpr const char* kLens = "volume:luneburg,resolution=8";

json with_volume(json node) {
    node["extras"] = {{"pellucid_volume", kLens}, {"other", "tool's"}};
    return node;
}

TEST(GltfVolumes, StandForTheGlassOfTheirNodesAndShareVoxels) {
    GltfBuilder b = GltfBuilder::triangle();
    b.root["extensionsUsed"] = {"KHR_materials_transmission", "KHR_materials_volume"};
    b.root["materials"] = {{{"extensions",
                             {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                              {"KHR_materials_volume", {{"thicknessFactor", 1}}}}}},
                           json::object()};
    json& glass = b.root["meshes"][0]["primitives"];
    json opaque = glass[0];
    glass[0]["material"] = 0;
    opaque["material"] = 1;
    glass.push_back(opaque);
    b.node(with_volume({{"mesh", 0}, {"name", "solid"}, {"translation", {1, 2, 3}}, {"scale", {-2, 2, 2}}}));
    b.node(with_volume({{"name", "bare"}}));
    b.root["scenes"][0]["nodes"] = {0, 1, 2};

    const TemporaryFolder folder;
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_NO_THROW(check_scene(scene));
    ASSERT_EQ(scene.objects.size(), 4u) << "glass and what is opaque, twice";
    ASSERT_EQ(scene.volume_objects.size(), 2u);
    EXPECT_EQ(scene.volumes.size(), 1u);
    const VolumeObject& solid = scene.volume_objects[0];
    EXPECT_EQ(solid.name, "solid");
    EXPECT_EQ(solid.objects, std::vector<int>{2}) << "its node's glass, not the other's, nor what is opaque";
    const glm::vec3 corner(solid.world_from_volume * glm::vec4(1, 1, 1, 1));
    EXPECT_EQ(corner, glm::vec3(-1, 4, 5));
    EXPECT_EQ(scene.volume_objects[1].volume, solid.volume);
    EXPECT_TRUE(scene.volume_objects[1].objects.empty());
}

}  // namespace
}  // namespace pellucid
