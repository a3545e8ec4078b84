// Renderer::set_positions(): a deformed mesh is drawn as if the scene had been set with it.
#include "gpu/gpu_test.h"
#include "unit/animated_gltf.h"

#include <pellucid/animation.h>

namespace pellucid::test {
namespace {

constexpr std::uint32_t kSize = 96;

/// A glass torus shown twice, a sphere beside it and an opaque plate behind: several meshes in one buffer.
Scene scene_of_three() {
    Scene scene = load_scene("shape:torus");
    const Scene sphere = load_scene("shape:sphere,segments=24");
    const Scene plate = load_scene("shape:slab,width=3,height=3,thickness=0.1");
    for (const Scene* other : {&sphere, &plate}) {
        Object object;
        object.mesh = int(scene.meshes.size());
        object.material = int(scene.materials.size());
        scene.meshes.push_back(other->meshes.at(0));
        scene.materials.push_back(other->materials.at(0));
        scene.objects.push_back(object);
    }
    scene.objects[1].world_from_object = glm::translate(glm::mat4(1.0f), glm::vec3(1.5f, 0.8f, 0.3f));
    scene.objects[2].world_from_object = glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, 0.0f, -2.0f));
    scene.materials[2] = Material{};
    scene.materials[2].base_color = {0.7f, 0.4f, 0.2f, 1.0f};
    Object again = scene.objects[0];
    again.world_from_object = glm::translate(glm::mat4(1.0f), glm::vec3(-1.0f, -1.0f, 0.5f));
    scene.objects.push_back(again);
    return scene;
}

/// Swells along the normal and grows along X, differently in every frame; normals are bent, too.
Mesh deformed(const Mesh& mesh, int frame) {
    Mesh result = mesh;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::vec3 p = mesh.positions[v];
        const float swell = 0.08f * std::sin(5.0f * p.y + float(frame));
        result.positions[v] = (p + swell * mesh.normals[v]) * glm::vec3(1.0f + 0.2f * float(frame), 1.0f, 1.0f);
        result.normals[v] = glm::normalize(mesh.normals[v] + glm::vec3(0.0f, 0.3f * swell, 0.1f * float(frame)));
    }
    return result;
}

MovedMesh moved(int index, const Mesh& mesh) { return {index, mesh.positions, mesh.normals}; }

RenderSettings settings_for(std::string technique) {
    RenderSettings settings;
    settings.width = settings.height = kSize;
    settings.technique = std::move(technique);
    settings.aovs = aovs_of_paths();
    return settings;
}

void expect_same(const RenderResult& a, const RenderResult& b, const std::string& what) {
    EXPECT_EQ(a.radiance.pixels, b.radiance.pixels) << what;
    EXPECT_EQ(a.covered, b.covered) << what;
    EXPECT_EQ(a.status, b.status) << what;
    for (const auto& [name, image] : a.aovs) EXPECT_EQ(image.pixels, b.aovs.at(name).pixels) << what << " " << name;
}

class Deforming : public RendererTest {
protected:
    std::vector<std::string> drawn() {
        std::vector<std::string> names = {"one-interface", "wyman-2005", "oliveira-brauwers-2007", "wang-2014",
                                          "reference"};
        if (renderer().lacking(find_technique("ray-tracing")).empty()) names.emplace_back("ray-tracing");
        return names;
    }
};

TEST_F(Deforming, PosesOfAFileAreDrawnAsIfLoadedThere) {
    const TemporaryFolder folder;
    GltfBuilder bar = hinged_bar();
    bar.root["materials"] = {{{"extensions",
                               {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                                {"KHR_materials_volume", {{"thicknessFactor", 1}}}}}}};
    bar.root["meshes"][0]["primitives"][0]["material"] = 0;
    const std::string file = bar.gltf(folder);
    LoadOptions options;
    options.time_s = 2.5;
    const Scene rest = load_scene(file), there = load_scene(file, options);
    const Pose pose = pose_at(rest, find_animation(rest, "bend"), 2.5);

    renderer().set_scene(rest);
    const RenderResult before = renderer().render(settings_for("wang-2014"));
    renderer().set_positions(pose.moved_meshes());
    const RenderResult posed = renderer().render(settings_for("wang-2014"));
    renderer().set_scene(there);
    const RenderResult loaded = renderer().render(settings_for("wang-2014"));
    EXPECT_GT(posed.covered, 0u);
    EXPECT_NE(posed.radiance.pixels, before.radiance.pixels);
    expect_same(posed, loaded, "bar");
}

TEST_F(Deforming, DrawsWhatAFreshRendererDraws) {
    const Scene rest = scene_of_three();
    renderer().set_scene(rest);
    std::map<std::string, RenderResult> before;
    for (const std::string& name : drawn()) before[name] = renderer().render(settings_for(name));
    for (int frame = 1; frame <= 3; ++frame) {
        Scene scene = rest;
        scene.meshes[0] = deformed(rest.meshes[0], frame);
        std::vector<MovedMesh> meshes = {moved(0, scene.meshes[0])};
        if (frame > 1) {  // the others follow later, two in one call
            scene.meshes[1] = deformed(rest.meshes[1], frame);
            scene.meshes[2] = deformed(rest.meshes[2], 4 - frame);
            meshes = {moved(2, scene.meshes[2]), moved(1, scene.meshes[1]), moved(0, scene.meshes[0])};
        }
        renderer().set_positions(meshes);
        Renderer fresh({.device = {}, .validation = true});
        fresh.set_scene(scene);
        for (const std::string& name : drawn()) {
            const RenderResult result = renderer().render(settings_for(name));
            expect_same(result, fresh.render(settings_for(name)), name + " frame " + std::to_string(frame));
            EXPECT_NE(result.radiance.pixels, before[name].radiance.pixels) << name;
            before[name] = result;
        }
        expect_silent(fresh.validation_messages());
    }
}

TEST_F(Deforming, WrongMeshesAreRefusedAndMoveNothing) {
    const Scene scene = scene_of_three();
    renderer().set_scene(scene);
    const RenderResult before = renderer().render(settings_for("wang-2014"));
    const RenderResult exact = renderer().render(settings_for("reference"));

    const Mesh good = deformed(scene.meshes[0], 2);
    Mesh few = scene.meshes[1], few_normals = scene.meshes[1], broken = scene.meshes[1];
    few.positions.pop_back();
    few_normals.normals.pop_back();
    broken.positions[3].y = std::numeric_limits<float>::quiet_NaN();
    Mesh broken_normal = scene.meshes[1];
    broken_normal.normals[3].y = std::numeric_limits<float>::infinity();
    const std::vector<MovedMesh> wrong = {moved(-1, good),        moved(3, good),        moved(1, good),
                                          moved(1, few),          moved(1, few_normals), moved(1, broken),
                                          moved(1, broken_normal)};
    for (const MovedMesh& each : wrong) {
        EXPECT_THROW(renderer().set_positions({moved(0, good), each}), Error);
        EXPECT_THROW(renderer().set_positions({each}), Error);
    }
    renderer().set_positions({});
    expect_same(renderer().render(settings_for("wang-2014")), before, "wang-2014");
    expect_same(renderer().render(settings_for("reference")), exact, "reference");

    renderer().set_scene(Scene{});
    EXPECT_THROW(renderer().set_positions({moved(0, good)}), Error);
}

}  // namespace
}  // namespace pellucid::test
