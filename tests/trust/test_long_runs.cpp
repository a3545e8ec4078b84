// Many images of one renderer: random edits without growth of memory, and every pair of technique, model, environment.
#include "trust/failing_device_test.h"
#include "trust/trust_scenes.h"
#include "unit/test_files.h"

#include <unistd.h>

#include <fstream>
#include <random>

namespace pellucid::test {
namespace {

std::int64_t resident_bytes() {
    std::int64_t total = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> total >> resident;
    return resident * sysconf(_SC_PAGESIZE);
}

/// Edits a renderer at random, as an interactive program does, and draws.
class Editor {
public:
    explicit Editor(Renderer& renderer)
        : renderer_(renderer), scenes_{table_scene(), crowd_scene(), table_scene("shape:gem")} {
        for (const TechniqueInfo* technique : techniques())
            if (renderer.lacking(*technique).empty()) techniques_.emplace_back(technique->name);
        renderer_.set_scene(scenes_[scene_]);
        settings_.width = settings_.height = 64;
    }

    RenderResult draw_edited() {
        edit();
        settings_.technique = techniques_[below(techniques_.size())];
        return renderer_.render(settings_);
    }

private:
    std::size_t below(std::size_t count) { return std::size_t(random_() % count); }
    float number() { return float(below(1000)) / 1000.0f; }

    void edit() {
        const Scene& scene = scenes_[scene_];
        switch (below(8)) {
            case 0:
                scene_ = below(scenes_.size());
                return renderer_.set_scene(scenes_[scene_]);
            case 1:
                settings_.width = std::uint32_t(64 - below(8));
                settings_.height = std::uint32_t(64 - below(8));
                return;
            case 2: {
                glm::mat4 moved = scene.objects.front().world_from_object;
                moved[3].x += number() - 0.5f;
                return renderer_.set_transforms({{.object = 0, .world_from_object = moved}});
            }
            case 3: {
                Material glass = scene.materials.front();
                glass.ior = 1.3f + number();
                return renderer_.set_material(0, glass);
            }
            case 4: {
                const Mesh& mesh = scene.meshes.front();
                std::vector<glm::vec3> positions = mesh.positions;
                for (glm::vec3& position : positions) position *= 1.0f + 0.1f * number();
                return renderer_.set_positions({{.mesh = 0, .positions = positions, .normals = mesh.normals}});
            }
            case 5: {
                std::vector<Light> lights(below(3));
                for (Light& light : lights) light.position = {number(), 3.0f, number()};
                return renderer_.set_lights(lights);
            }
            case 6:
                return renderer_.set_environment(load_environment(below(2) == 0 ? "sky" : "studio"));
            default:
                return renderer_.turn_environment(number(), number());
        }
    }

    Renderer& renderer_;
    std::mt19937 random_{25};
    std::vector<Scene> scenes_;
    std::size_t scene_ = 0;
    std::vector<std::string> techniques_;
    RenderSettings settings_;
};

class LongRuns : public FailingDeviceTest {
protected:
    void edit_and_draw(int frames) {
        Renderer renderer(validated());
        Editor editor(renderer);
        std::int64_t settled = 0, allocations = 0;
        for (int frame = 0; frame < frames; ++frame) {
            const RenderResult result = editor.draw_edited();
            ASSERT_TRUE(all_finite(result.radiance)) << frame;
            expect_silent(renderer.validation_messages());
            ASSERT_FALSE(HasFailure()) << frame;
            if (frame < frames / 3) allocations = std::max<std::int64_t>(allocations, failures().live);
            if (frame == frames / 3) settled = resident_bytes();
            if (frame > frames / 3) {
                ASSERT_LE(failures().live, allocations + allocations / 4) << frame;
            }
        }
        const double grown = double(resident_bytes() - settled) / 1048576.0;
        RecordProperty("grown MiB", std::to_string(grown));
        EXPECT_LT(grown, 64.0) << "MiB since the first third";
    }
};

TEST_F(LongRuns, FramesWithRandomEditsDoNotGrow) { edit_and_draw(300); }

TEST_F(LongRuns, ManyFramesWithRandomEditsDoNotGrow) { edit_and_draw(24000); }

std::vector<std::string> files_of(const char* folder, std::initializer_list<std::string_view> extensions) {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(data_folder() / folder))
        if (entry.is_regular_file() && std::ranges::count(extensions, entry.path().extension().string()) > 0)
            files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

class Sweep : public RendererTest {};

/// Every model with every technique, and the environments in turn: with one more for each, all pairs occur.
TEST_F(Sweep, EveryPairOfTechniqueModelAndEnvironment) {
    if (data_folder().empty()) GTEST_SKIP() << "PELLUCID_TEST_DATA names no folder";
    std::vector<std::string> models = files_of("models", {".obj", ".ply", ".off", ".stl"});
    for (const std::string& file : files_of("gltf", {".gltf", ".glb"})) models.push_back(file);
    std::vector<std::string> environments = files_of("hdri", {".hdr", ".exr"});
    for (const char* name : {"studio", "checker", "sky", "uniform"}) environments.emplace_back(name);
    std::vector<const TechniqueInfo*> usable;
    for (const TechniqueInfo* technique : techniques())
        if (renderer().lacking(*technique).empty()) usable.push_back(technique);
    std::vector<Environment> loaded;
    for (const std::string& name : environments) loaded.push_back(load_environment(name));
    std::size_t drawn = 0, models_drawn = 0;
    for (const std::string& model : models) {
        SCOPED_TRACE(model);
        try {
            renderer().set_scene(load_scene(model));
        } catch (const Error&) {
            continue;  // test_every_model.cpp and the loaders' tests say which these are
        }
        for (std::size_t i = 0; i < std::max(usable.size(), loaded.size()); ++i) {
            const TechniqueInfo& technique = *usable[i % usable.size()];
            const std::size_t environment = (models_drawn + i) % loaded.size();
            SCOPED_TRACE(std::string(technique.name) + " in " + environments[environment]);
            renderer().set_environment(loaded[environment]);
            RenderSettings settings;
            settings.width = settings.height = 64;
            settings.technique = technique.name;
            const RenderResult result = renderer().render(settings);
            EXPECT_TRUE(all_finite(result.radiance));
            EXPECT_TRUE(all_finite(result.display));
            expect_silent(renderer().validation_messages());
            if (HasFailure()) return;
            ++drawn;
        }
        ++models_drawn;
    }
    EXPECT_GE(models_drawn, loaded.size()) << "too few models for all pairs";
    RecordProperty("images", std::to_string(drawn));
}

}  // namespace
}  // namespace pellucid::test
