// KHR_lights_punctual: what the loader makes of right and wrong lights.
#include "core/math.h"
#include "gltf_builder.h"
#include "scene/check_scene.h"
#include "test_files.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pellucid {
namespace {

using namespace test;

/// A triangle, and a node that refers to one of `lights`.
GltfBuilder with_lights(const json& lights, json node = json::object(), const json& reference = {{"light", 0}}) {
    GltfBuilder b = GltfBuilder::triangle();
    b.root["extensionsUsed"] = b.root["extensionsRequired"] = {"KHR_lights_punctual"};
    b.root["extensions"] = {{"KHR_lights_punctual", {{"lights", lights}}}};
    node["extensions"] = {{"KHR_lights_punctual", reference}};
    b.node(node);
    b.root["scenes"][0]["nodes"] = {0, 1};
    return b;
}

/// The same for one light.
GltfBuilder with_light(const json& light, json node = json::object(), const json& reference = {{"light", 0}}) {
    return with_lights(json::array({light}), std::move(node), reference);
}

Scene load(GltfBuilder b) {
    const TemporaryFolder folder;
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_EQ(broken_promise(scene), "");
    EXPECT_NO_THROW(check_scene(scene));
    return scene;
}

std::string error_of(GltfBuilder b) {
    const TemporaryFolder folder;
    return load_error(b.gltf(folder));
}

void expect_near(glm::vec3 value, glm::vec3 expected) {
    EXPECT_LT(glm::distance(value, expected), 1e-5f) << value.x << " " << value.y << " " << value.z;
}

TEST(GltfLights, PointLight) {
    const json light = {{"type", "point"}, {"color", {1.0, 0.5, 0.25}}, {"intensity", 20}, {"range", 7}};
    const Scene scene = load(with_light(light, {{"name", "lamp"}, {"translation", {1, 2, 3}}}));
    EXPECT_TRUE(scene.warnings.empty());
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].kind, Light::Kind::kPoint);
    EXPECT_EQ(scene.lights[0].name, "lamp") << "its node's, as it has none of its own";
    expect_near(scene.lights[0].intensity, {20, 10, 5});
    expect_near(scene.lights[0].position, {1, 2, 3});
    EXPECT_EQ(scene.lights[0].range, 7.0f);
}

TEST(GltfLights, Defaults) {
    const Scene scene = load(with_light({{"type", "spot"}, {"name", "stage"}, {"spot", json::object()}}));
    ASSERT_EQ(scene.lights.size(), 1u);
    const Light& light = scene.lights[0];
    EXPECT_EQ(light.name, "stage");
    EXPECT_EQ(light.intensity, glm::vec3(1.0f));
    EXPECT_TRUE(std::isinf(light.range));
    EXPECT_EQ(light.inner_cone_angle, 0.0f);
    EXPECT_NEAR(light.outer_cone_angle, kPi / 4, 1e-6f);
    expect_near(light.direction, {0, 0, -1});
}

TEST(GltfLights, SizesAreExtras) {
    const auto light = [](const char* type, json extras) {
        return load(with_light({{"type", type}, {"spot", json::object()}, {"extras", std::move(extras)}}));
    };
    EXPECT_EQ(light("point", {{"radius", 0.25}}).lights.at(0).radius, 0.25f);
    EXPECT_EQ(light("spot", {{"radius", 2}}).lights.at(0).radius, 2.0f);
    EXPECT_EQ(light("directional", {{"angular_diameter", 0.5}}).lights.at(0).angular_diameter, 0.5f);
    const Scene plain = light("directional", json::object());
    EXPECT_NEAR(plain.lights.at(0).angular_diameter, 0.53f * kPi / 180, 1e-7f) << "the sun's";
    EXPECT_EQ(plain.lights.at(0).radius, 0.0f);
    EXPECT_EQ(light("point", {{"radius", "wide"}}).lights.at(0).radius, 0.0f);
    const Scene negative = light("point", {{"radius", -1}});
    EXPECT_EQ(negative.lights.at(0).radius, 0.0f);
    EXPECT_EQ(warnings_with(negative, "radius -1 is out of range, 0 used"), 1u);
    EXPECT_EQ(light("directional", {{"angular_diameter", 7}}).warnings.size(), 1u);
}

TEST(GltfLights, LooksAlongItsNodesMinusZWhateverTheScale) {
    // A quarter turn about +x takes -z to +y; the parent's half turn about +z takes that to -y.
    const float h = std::sqrt(0.5f);
    json node = {{"rotation", {h, 0, 0, h}}, {"translation", {1, 0, 0}}, {"scale", {5, 6, 7}}};
    GltfBuilder b = with_light({{"type", "directional"}, {"intensity", 3}}, node);
    b.node({{"rotation", {0, 0, 1, 0}}, {"children", {1}}});
    b.root["scenes"][0]["nodes"] = {0, 2};
    const Scene scene = load(b);
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].kind, Light::Kind::kDirectional);
    expect_near(scene.lights[0].direction, {0, -1, 0});
    expect_near(scene.lights[0].intensity, {3, 3, 3});
}

TEST(GltfLights, NumbersOutOfRangeGiveAWarning) {
    const auto spot = [](json cone) { return load(with_light({{"type", "spot"}, {"name", "s"}, {"spot", cone}})); };
    Scene scene = spot({{"innerConeAngle", 1.0}, {"outerConeAngle", 0.5}});
    EXPECT_EQ(warnings_with(scene, "light s: innerConeAngle 1 is out of range, 0.5 used"), 1u);
    EXPECT_LT(scene.lights.at(0).inner_cone_angle, scene.lights.at(0).outer_cone_angle);
    EXPECT_NEAR(scene.lights.at(0).inner_cone_angle, 0.5f, 1e-5f);
    scene = spot({{"innerConeAngle", -1.0}, {"outerConeAngle", 3.0}});
    EXPECT_EQ(scene.warnings.size(), 2u);
    EXPECT_EQ(scene.lights.at(0).inner_cone_angle, 0.0f);
    EXPECT_NEAR(scene.lights.at(0).outer_cone_angle, kPi / 2, 1e-6f);
    EXPECT_GT(spot({{"outerConeAngle", 0}}).lights.at(0).outer_cone_angle, 0.0f);

    scene = load(
        with_light({{"type", "point"}, {"name", "p"}, {"intensity", -4}, {"range", -1}, {"color", {2.0, 1.0, -1.0}}}));
    EXPECT_EQ(scene.warnings.size(), 4u);
    EXPECT_EQ(scene.lights.at(0).intensity, glm::vec3(0.0f));
    EXPECT_TRUE(std::isinf(scene.lights.at(0).range));
    scene = load(with_light({{"type", "point"}, {"intensity", 1e300}}));
    EXPECT_TRUE(std::isfinite(scene.lights.at(0).intensity.x));
}

TEST(GltfLights, LeftOutWithAWarning) {
    const Scene unknown = load(with_light({{"type", "neon"}}));
    EXPECT_TRUE(unknown.lights.empty());
    EXPECT_EQ(warnings_with(unknown, "its type 'neon' is not known"), 1u);
    const Scene flat = load(with_light({{"type", "directional"}}, {{"scale", {1, 1, 0}}}));
    EXPECT_TRUE(flat.lights.empty());
    EXPECT_EQ(warnings_with(flat, "points nowhere"), 1u);
}

TEST(GltfLights, MalformedFilesAreErrorsOrKeepDefaults) {
    const json point = {{"type", "point"}};
    EXPECT_NE(error_of(with_light(point, {{"name", "lamp"}}, {{"light", 1}})).find("lamp: there is no light 1"),
              std::string::npos);
    EXPECT_NE(error_of(with_light(point, {}, {{"light", -1}})).find("there is no light -1"), std::string::npos);
    EXPECT_NE(error_of(with_light(point, {}, {{"light", "x"}})).find("does not say which light"), std::string::npos);
    EXPECT_NE(error_of(with_light(point, {}, json::object())).find("does not say which light"), std::string::npos);
    EXPECT_NE(error_of(with_lights("none")).find("there is no light 0"), std::string::npos);
    for (const char* light : {"{}", "3", "{\"type\": 5}", "{\"type\": \"spot\"}"}) {
        const std::string error = error_of(with_light(json::parse(light)));
        EXPECT_NE(error, "") << light;
        EXPECT_EQ(error.find('\n'), std::string::npos);
    }
    const json odd = {{"type", "point"}, {"intensity", "much"}, {"color", {1, 2}}, {"range", json::array()}};
    const Scene scene = load(with_light(odd));
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].intensity, glm::vec3(1.0f));
}

TEST(GltfLights, CheckedWhenBuiltByHand) {
    const TemporaryFolder folder;
    Scene scene = load_scene(GltfBuilder::triangle().gltf(folder));
    const auto broken = [&](auto&& change) {
        scene.lights = {Light{}};
        change(scene.lights[0]);
        try {
            check_scene(scene);
        } catch (const Error&) {
            return true;
        }
        return false;
    };
    EXPECT_FALSE(broken([](Light&) {}));
    EXPECT_TRUE(broken([](Light& l) { l.intensity.y = -1.0f; }));
    EXPECT_TRUE(broken([](Light& l) { l.intensity.z = std::numeric_limits<float>::infinity(); }));
    EXPECT_TRUE(broken([](Light& l) { l.position.x = std::nanf(""); }));
    EXPECT_TRUE(broken([](Light& l) { l.direction = glm::vec3(1.0f); }));
    EXPECT_TRUE(broken([](Light& l) { l.range = 0.0f; }));
    EXPECT_TRUE(broken([](Light& l) { l.inner_cone_angle = l.outer_cone_angle; }));
    EXPECT_TRUE(broken([](Light& l) { l.outer_cone_angle = 4.0f; }));
    EXPECT_TRUE(broken([](Light& l) { l.radius = -1.0f; }));
    EXPECT_TRUE(broken([](Light& l) { l.radius = std::numeric_limits<float>::infinity(); }));
    EXPECT_TRUE(broken([](Light& l) { l.angular_diameter = -0.1f; }));
    EXPECT_TRUE(broken([](Light& l) { l.angular_diameter = kPi; }));
}

}  // namespace
}  // namespace pellucid
