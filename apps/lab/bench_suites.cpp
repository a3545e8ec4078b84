#include "lab/bench_suites.h"

#include "lab/accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pellucid::cli {
namespace {

namespace fs = std::filesystem;

constexpr float kElevationDeg = 15.0f;

/// Wang 2014 measures its models at distances 10 and 20 without saying in what unit: near and far are as one to two
/// here as well, and at the near one the bounding sphere fills three quarters of the height.
constexpr float kNear = 5.0f, kFar = 10.0f;  // bounding-sphere radii

class Suite {
public:
    explicit Suite(ModelFolder& models) : models_(models) {}

    void add(BenchCase bench_case) { cases_.push_back(std::move(bench_case)); }
    void add_shape(const std::string& shape, BenchCase how) {
        how.scene = how.source = "shape:" + shape;
        add(how);
    }
    void add_model(const Model& model, BenchCase how) {
        const fs::path file = models_.find(model);
        how.scene = file.filename().string();
        how.source = file.string();
        if (!file.empty()) add(how);
    }
    std::vector<BenchCase> cases() && { return std::move(cases_); }

private:
    ModelFolder& models_;
    std::vector<BenchCase> cases_;
};

void add_quick(Suite& suite) {
    for (const char* shape : {"sphere,segments=8", "goblet"}) suite.add_shape(shape, {.size = std::pair(256u, 256u)});
}

void add_thesis(Suite& suite) {
    for (const float distance : {kFar, kNear}) {
        const BenchCase how{.varied = "distance", .distance = distance};
        suite.add_shape("sphere,segments=8", how);  // 512 triangles
        suite.add_model(kCow, how);
        suite.add_shape("torus,segments=24,sides=12", how);          // 576
        suite.add_shape("infinity-ring,segments=60,sides=20", how);  // 2,400
        suite.add_model(kBunny, how);
    }
}

void add_scaling(Suite& suite) {
    for (const int segments : {11, 35, 112, 354})  // 968 to 1,002,528 triangles
        suite.add_shape(fmt::format("sphere,segments={}", segments), {.varied = "triangles"});
    using Size = std::pair<std::uint32_t, std::uint32_t>;
    for (const Size& size : {Size(256, 256), Size(512, 512), Size(1024, 1024), Size(1920, 1080), Size(3840, 2160)})
        suite.add_shape("torus", {.varied = "size", .size = size});
    for (const double layers : {2.0, 4.0, 8.0, 16.0}) suite.add_shape("knot", {.varied = "layers", .layers = layers});
    for (const int copies : {1, 4, 16, 64})
        suite.add_shape("sphere,segments=16", {.varied = "objects", .copies = copies});
}

struct SuiteInfo {
    const char* name;
    const char* doc;
    void (*add)(Suite& suite);
};
constexpr std::array<SuiteInfo, 3> kSuites{
    {{"quick", "two shapes at 256x256, seconds", add_quick},
     {"thesis", "the models of Wang 2014, table 4.1, far and near", add_thesis},
     {"scaling", "1,000 to 1,000,000 triangles, 256x256 to 3840x2160 pixels, 2 to 16 layers, 1 to 64 objects",
      add_scaling}}};

}  // namespace

Camera bench_camera(const BenchCase& bench_case, const Scene& scene, std::uint32_t width, std::uint32_t height) {
    const Bounds bounds = scene_bounds(scene);
    if (bench_case.distance)
        return orbit_camera(bounds, 0.0f, kElevationDeg, *bench_case.distance, Camera{}.vertical_fov);
    return scene.cameras.empty() ? comparison_view(bounds, 0, 1, width, height).camera(bounds) : scene.cameras.front();
}

Scene with_copies(Scene scene, int copies) {
    constexpr float kSpacing = 2.2f;  // radii, so that bounding spheres stay apart
    const float step = kSpacing * scene_bounds(scene).radius;
    const int side = int(std::ceil(std::sqrt(double(copies))));
    const std::vector<Object> originals = std::move(scene.objects);
    scene.objects.clear();
    for (int i = 0; i < copies; ++i) {
        const glm::vec3 offset(step * float(i % side), step * float(i / side), 0.0f);
        for (Object object : originals) {
            object.world_from_object[3] += glm::vec4(offset, 0.0f);
            scene.objects.push_back(std::move(object));
        }
    }
    return scene;
}

std::vector<BenchCase> suite_cases(const std::string& name, ModelFolder& models) {
    std::vector<std::string_view> known;
    for (const SuiteInfo& info : kSuites) {
        if (info.name == name) {
            Suite suite(models);
            info.add(suite);
            return std::move(suite).cases();
        }
        known.emplace_back(info.name);
    }
    throw unknown_name("suite", name, known);
}

std::vector<std::pair<std::string_view, std::string_view>> suite_infos() {
    std::vector<std::pair<std::string_view, std::string_view>> infos;
    for (const SuiteInfo& info : kSuites) infos.emplace_back(info.name, info.doc);
    return infos;
}

}  // namespace pellucid::cli
