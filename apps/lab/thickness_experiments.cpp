// The experiments of Chen, "Real-time transmission of translucent objects by depth peeling".
#include "lab/thickness_experiments.h"

#include "lab/experiment_run.h"
#include "options/progress_bar.h"
#include "options/translucency_options.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <map>
#include <utility>

namespace pellucid::cli {
namespace {

constexpr Model kDragon{"dragon", {"photon_dragon.obj", nullptr}};
constexpr std::size_t kDragonTriangles = 514372;
constexpr std::array<glm::vec3, 3> kBalls = {glm::vec3(0.0f, 0.2f, 4.0f), glm::vec3(0.0f, 0.2f, 3.2f),
                                             glm::vec3(0.0f, 0.2f, 2.4f)};
constexpr float kBallRadius = 0.3f;           // the paper's is lost
constexpr glm::vec3 kLamp(0.0f, 0.2f, 6.0f);  // one position of the paper's white ball, which is lost
constexpr float kErrorScale = 0.1f;           // of the pictures of errors, in the thickest place

Material wax() {
    Material material;
    material.name = "wax";
    material.roughness = 0.5f;
    material.thickness = 1.0f;
    material.diffuse_transmission = 0.5f;
    return material;
}

Light sun(const glm::vec3& way) {
    Light light;
    light.kind = Light::Kind::kDirectional;
    light.direction = glm::normalize(way);
    return light;
}

/// The balls, green, red and blue from the light.
Scene three_balls() {
    Scene scene = load_scene(fmt::format("shape:sphere,segments=160,radius={}", kBallRadius));
    scene.materials.assign(1, wax());
    const Object ball = scene.objects.front();
    scene.objects.clear();
    for (const glm::vec3& center : kBalls) {
        scene.objects.push_back(ball);
        scene.objects.back().world_from_object = glm::translate(glm::mat4(1.0f), center);
    }
    scene.lights.push_back(sun({0.0f, 0.0f, -1.0f}));
    return scene;
}

void print_run(const Console& console, const nlohmann::ordered_json& run) {
    console.print("{:<10} {:<32} {:>9.3f}% {:>10.3g} m {:>9.1f} ms\n", run["scene"].get<std::string>(),
                  run["variant"].get<std::string>(), 100.0 * run["relative_error"].get<double>(),
                  run["largest_m"].get<double>(), run.contains("wall_ms") ? run["wall_ms"].get<double>() : 0.0);
}

nlohmann::ordered_json run_of(const ExperimentRun& run, const std::string& scene, const std::string& variant,
                              const ThicknessError& error) {
    return {{"scene", scene},
            {"variant", variant},
            {"width", run.width},
            {"height", run.height},
            {"points", error.points},
            {"unmatched", error.unmatched},
            {"relative_error", error.relative},
            {"mean_m", error.mean},
            {"p95_m", error.p95},
            {"largest_m", error.largest}};
}

void add_pictures(ExperimentPage& page, const std::string& scene, const std::string& caption, const Image& truth,
                  const Image& thickness, Image difference) {
    const float full = largest_value(truth);
    page.add_picture(scene, caption, color_thickness(thickness, full));
    for (std::size_t i = 0; i < difference.pixels.size(); ++i) {
        if (truth.pixels[i] < 0.0f && thickness.pixels[i] < 0.0f) difference.pixels[i] = kNotTranslucent;
    }
    page.add_picture(scene + ", error", caption, color_thickness(difference, kErrorScale * full));
}

/// One view of the balls under one light, and its exact thickness.
struct BallView {
    std::string name;
    Camera camera;
    Image truth;
};

void add_ball_run(ExperimentRun& run, ExperimentPage& page, const BallView& view, const std::string& variant,
                  const Image& thickness, bool pictured) {
    Image difference;
    const ThicknessError error = thickness_error(view.truth, thickness, &difference);
    nlohmann::ordered_json json = run_of(run, view.name, variant, error);
    print_run(run.console, json);
    run.runs.push_back(std::move(json));
    if (pictured) add_pictures(page, view.name, variant, view.truth, thickness, std::move(difference));
}

/// Every method, those of ours with every resolution of the light's map if they have one.
void measure_methods(ExperimentRun& run, ExperimentPage& page, const BallView& view,
                     std::span<const std::uint32_t> resolutions) {
    constexpr std::uint32_t kPictured = 1024;
    for (const ThicknessMethodInfo& info : thickness_methods()) {
        for (const std::uint32_t resolution : resolutions) {
            const bool baked = info.method == ThicknessMethod::kLocalThickness ||
                               info.method == ThicknessMethod::kPublishedLocalThickness;
            const bool once = baked || info.name.starts_with("published");  // baked values have no map
            if (once && resolution != kPictured) continue;
            const ThicknessResult result = run.renderer.measure_thickness({.width = run.width,
                                                                           .height = run.height,
                                                                           .settings = {info.method, 6, resolution},
                                                                           .light = 0,
                                                                           .progress = {}});
            run.warnings.insert(result.warnings.begin(), result.warnings.end());
            const std::string variant = baked ? std::string(info.name) : fmt::format("{}, {}", info.name, resolution);
            add_ball_run(run, page, view, variant, result.thickness, resolution == kPictured);
        }
    }
}

/// Exact is the marched distance field under the sun, and Embree's rays under a lamp.
void measure_light(ExperimentRun& run, const ExperimentSpec& spec, ExperimentPage& page, const std::string& name,
                   const Light& light, std::span<const std::uint32_t> resolutions) {
    Scene scene = three_balls();
    scene.lights.assign(1, light);
    std::vector<Ball> balls;
    for (const glm::vec3& center : kBalls) balls.push_back({center, double(kBallRadius)});
    const DistanceField field = distance_to(balls);
    const ThicknessTracer tracer(scene, run.threads);
    const bool marched = light.kind == Light::Kind::kDirectional;
    run.renderer.set_scene(scene);
    for (const auto& [from, camera] : cameras_about_light(scene, light, run.width, run.height)) {
        run.renderer.set_camera(camera);
        Image traced = tracer.trace(camera, run.width, run.height, 0);
        BallView view{fmt::format("{}, {}", name, from), camera, traced};
        if (marched) {
            view.truth = march_thickness(field, scene_bounds(scene), camera, run.width, run.height, light.direction,
                                         run.threads);
            add_ball_run(run, page, view, "rays of Embree", traced, false);
        }
        page.add_picture(view.name, spec.truth.label, color_thickness(view.truth, largest_value(view.truth)));
        measure_methods(run, page, view, resolutions);
    }
}

void measure_error(ExperimentRun& run, const ExperimentSpec& spec, ModelFolder&, ExperimentPage& page) {
    measure_light(run, spec, page, "sun", sun({0.0f, 0.0f, -1.0f}), std::array{128u, 256u, 512u, 1024u, 2048u});
    Light lamp;
    lamp.position = kLamp;
    measure_light(run, spec, page, "lamp", lamp, std::array{1024u});
}

/// Figures 7 and 8: the dragon drawn with each method, from the side and from the top.
void draw_figures(ExperimentRun& run, Scene scene, ExperimentPage& page) {
    scene.materials[0].attenuation_color = {0.7f, 0.25f, 0.1f};
    scene.materials[0].attenuation_distance = 0.15f * scene_bounds(scene).radius;
    scene.lights[0].intensity = glm::vec3(12.0f);
    run.renderer.set_scene(scene);
    run.renderer.set_environment(load_environment("uniform"));
    const std::vector<NamedCamera> cameras = cameras_about_light(scene, scene.lights[0], run.width, run.height);
    for (const NamedCamera& camera : {cameras.at(1), cameras.at(2)}) {
        run.renderer.set_camera(camera.camera);
        for (const ThicknessMethod method : {ThicknessMethod::kPublishedShadowMap,
                                             ThicknessMethod::kPublishedDepthPeeling, ThicknessMethod::kDepthPeeling}) {
            RenderSettings settings;
            settings.width = run.width;
            settings.height = run.height;
            settings.technique = "visibility-layers";
            settings.exposure_ev = -1.0f;
            settings.thickness = {method, 12, 1024};
            page.add_picture(fmt::format("dragon drawn, {}", camera.name),
                             std::string(thickness_methods()[std::size_t(method)].name),
                             run.renderer.render(settings).display);
        }
    }
}

void measure_speed(ExperimentRun& run, const ExperimentSpec& spec, ModelFolder& models, ExperimentPage& page) {
    const std::filesystem::path file = models.find(kDragon);
    if (file.empty()) {
        run.warnings.insert("nothing is left to measure");
        return;
    }
    Scene scene;
    if (!run.unread.read(file.string(), [&] { scene = load_scene(file.string()); })) return;
    run.warnings.insert(scene.warnings.begin(), scene.warnings.end());
    const std::size_t before = scene.meshes[0].triangles.size();
    while (scene.meshes[0].triangles.size() < kDragonTriangles)
        scene.meshes[0] = with_split_edges(scene.meshes[0], kDragonTriangles);
    run.warnings.insert(fmt::format("{}: the longest edges of its {} triangles are split to make {}",
                                    file.filename().string(), before, scene.meshes[0].triangles.size()));
    scene.materials.assign(1, wax());
    scene.lights.push_back(sun({0.3f, -0.4f, -1.0f}));
    const Camera camera = cameras_about_light(scene, scene.lights[0], run.width, run.height)[0].camera;
    run.renderer.set_scene(scene);
    run.renderer.set_camera(camera);
    const Image truth = ThicknessTracer(scene, run.threads).trace(camera, run.width, run.height, 0);
    page.add_picture("dragon", spec.truth.label, color_thickness(truth, largest_value(truth)));
    std::map<std::uint32_t, double> single_ms, single_wall_ms;
    for (const std::uint32_t layers : {4u, 8u, 12u}) {
        std::optional<Image> peeled;
        for (const ThicknessMethod method :
             {ThicknessMethod::kDepthPeeling, ThicknessMethod::kDualDepthPeeling, ThicknessMethod::kLayers}) {
            const std::string name(thickness_methods()[std::size_t(method)].name);
            const ThicknessRequest request{.width = run.width,
                                           .height = run.height,
                                           .settings = {method, layers, 1024},
                                           .light = 0,
                                           .time_maps = true,
                                           .progress = {}};
            ProgressBar bar(run.console, fmt::format("{}: {}, {} layers", spec.name, name, layers));
            ThicknessResult result = run.renderer.measure_thickness(request);  // compiles, and learns of the scene
            std::vector<double> times_ms, maps_ms;
            for (int frame = 0; frame < run.frames; ++frame) {
                bar.show(double(frame) / run.frames);
                result = run.renderer.measure_thickness(request);
                times_ms.push_back(result.wall_ms);
                maps_ms.push_back(result.map_ms);
            }
            bar.clear();
            if (!peeled) peeled = result.thickness;
            Image difference;
            const ThicknessError error = thickness_error(truth, result.thickness, &difference);
            nlohmann::ordered_json json = run_of(run, "dragon", fmt::format("{}, {} layers", name, layers), error);
            json["triangles"] = scene.triangle_count();
            json["layers"] = layers;
            json["light_map"] = 1024;
            json["frames"] = times_ms.size();
            json["geometry_passes"] = result.geometry_passes;
            json["cut_rays"] = result.cut_rays;
            json["wall_ms"] = spread(times_ms).median;
            json["map_ms"] = spread(maps_ms).median;
            json["from_peeled"] = thickness_error(*peeled, result.thickness).relative;
            const double map_ms = json["map_ms"], wall_ms = json["wall_ms"];
            if (method == ThicknessMethod::kDepthPeeling) single_ms[layers] = map_ms, single_wall_ms[layers] = wall_ms;
            json["times_as_fast"] = single_ms[layers] / map_ms;
            json["frame_times_as_fast"] = single_wall_ms[layers] / wall_ms;
            print_run(run.console, json);
            run.runs.push_back(std::move(json));
            if (layers == 12) add_pictures(page, "dragon", name, truth, result.thickness, std::move(difference));
        }
    }
    draw_figures(run, std::move(scene), page);
}

constexpr Column kError{"sum abs(d - d*) / sum d*, %", "/relative_error", 100.0, 3};
constexpr Column kMean{"mean error, mm", "/mean_m", 1000.0, 3};
constexpr Column k95{"95% of errors below, mm", "/p95_m", 1000.0, 3};
constexpr Column kTriangles{"triangles", "/triangles", 1.0, 0};
constexpr Column kPoints{"points", "/points", 1.0, 0};
constexpr Column kUnmatched{"of the silhouette", "/unmatched", 1.0, 0};

}  // namespace

ExperimentSpec chen_error() {
    return {
        .name = "chen-error",
        .source = "Chen, section 3.1, table 1: error of the thickness of three balls",
        .varied = "light, method, and texels along a side of the light's map",
        .size = {1920, 1080},
        .truth = {"exact", "reference"},
        .run = measure_error,
        .columns = {kPoints, kUnmatched, kError, kMean, k95},
        .remark =
            "The paper's light is the white ball of its figure, whose position is lost: ours are a sun along the axis "
            "of the balls, and a lamp on this axis, 1.7 m before the first ball. Exact is the marched distance field "
            "under the sun, and Embree's rays under the lamp. Methods called `published` follow the text to the word; "
            "the others are ours. Radius 0.3 m, which is lost in the paper. Pixels that only the balls or only their "
            "triangles cover "
            "count with all of their thickness. Pictures of errors end at a tenth of the thickest place."};
}

ExperimentSpec chen_speed() {
    return {.name = "chen-speed",
            .source = "Chen, section 3.2, table 2: single against dual depth peeling of a dragon of 514,372 triangles",
            .varied = "method, and number of layers",
            .size = {1920, 1080},
            .truth = {"rays of Embree", "reference"},
            .run = measure_speed,
            .columns = {kTriangles,
                        {"geometry passes", "/geometry_passes", 1.0, 0},
                        {"light's map, ms", "/map_ms"},
                        {"map: times as fast as depth-peeling's", "/times_as_fast", 1.0, 2},
                        {"whole frame, ms", "/wall_ms"},
                        {"frame: times as fast as depth-peeling's", "/frame_times_as_fast", 1.0, 2},
                        kError,
                        {"from depth-peeling's, %", "/from_peeled", 100.0, 4},
                        {"points with more surfaces", "/cut_rays", 1.0, 0}},
            .remark =
                "A map of 1024x1024. Times are medians, host and device: of building the light's map alone, and of "
                "the whole frame, with the camera's passes and the sums at every pixel."};
}

Mesh with_split_edges(const Mesh& mesh, std::size_t count) {
    if (count <= mesh.triangles.size()) return mesh;
    const auto length = [&](std::uint32_t a, std::uint32_t b) {
        // The same for both triangles of an edge.
        return glm::distance(mesh.positions[std::min(a, b)], mesh.positions[std::max(a, b)]);
    };
    // A triangle gives one more for each of its edges that is split.
    std::vector<float> lengths;
    for (const glm::uvec3 t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) lengths.push_back(length(t[k], t[(k + 1) % 3]));
    }
    const std::size_t splits = std::min(count - mesh.triangles.size(), lengths.size());
    std::nth_element(lengths.begin(), lengths.begin() + std::ptrdiff_t(splits) - 1, lengths.end(), std::greater<>());
    const float shortest = lengths[splits - 1];

    Mesh split = mesh;
    split.triangles.clear();
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [found, is_new] =
            middles.try_emplace({std::min(a, b), std::max(a, b)}, std::uint32_t(split.positions.size()));
        if (is_new) {
            split.positions.push_back(0.5f * (mesh.positions[a] + mesh.positions[b]));
            const glm::vec3 normal = mesh.normals[a] + mesh.normals[b];
            split.normals.push_back(glm::length(normal) > 0.0f ? glm::normalize(normal) : mesh.normals[a]);
            for (auto& set : split.texcoords) {
                if (!set.empty()) set.push_back(0.5f * (set[a] + set[b]));
            }
            if (!split.colors.empty()) split.colors.push_back(0.5f * (mesh.colors[a] + mesh.colors[b]));
        }
        return found->second;
    };
    split.tangents.clear();
    for (const glm::uvec3 t : mesh.triangles) {
        // The corners and the middles of split edges, around; then an ear at a time.
        std::vector<std::uint32_t> around;
        std::vector<std::size_t> made;
        for (int k = 0; k < 3; ++k) {
            around.push_back(t[k]);
            if (length(t[k], t[(k + 1) % 3]) < shortest) continue;
            made.push_back(around.size());
            around.push_back(middle(t[k], t[(k + 1) % 3]));
        }
        if (made.size() == 3) {
            split.triangles.emplace_back(around[1], around[3], around[5]);
            for (const std::size_t i : {1, 3, 5})
                split.triangles.emplace_back(around[i], around[(i + 1) % 6], around[(i + 2) % 6]);
        } else if (made.empty()) {
            split.triangles.push_back(t);
        } else {
            // From a middle all others are seen, none along an edge but its two neighbours.
            const std::size_t from = made.front(), n = around.size();
            for (std::size_t i = 1; i + 1 < n; ++i)
                split.triangles.emplace_back(around[from], around[(from + i) % n], around[(from + i + 1) % n]);
        }
    }
    return split;
}

}  // namespace pellucid::cli
