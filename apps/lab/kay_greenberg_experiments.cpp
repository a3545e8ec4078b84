// Kay & Greenberg, "Transparency for Computer Synthesized Images", SIGGRAPH 1979: the evaluation of section 4.3,
// measured.
#include "lab/kay_greenberg_experiments.h"

#include "lab/experiment_run.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pellucid::cli {
namespace {

constexpr const char* kKayGreenberg = "kay-greenberg-1979";
constexpr double kFaceOn = 0.9;      // transparency of a surface seen from the front
constexpr float kElevation = 15.0f;  // degrees
constexpr float kShare = 0.7f;       // of the image height, of the bounding sphere
constexpr float kBackdrop = 1.5f;    // distance of the checkered plane behind the centre, bounding-sphere radii

/// `shape` with the paper's slabs: a wall is two surfaces, so each is a slab of half the wall.
Scene vessel(const std::string& shape, float wall) {
    Scene scene = load_scene(fmt::format("shape:{},wall={}", shape, wall));
    Material& glass = scene.materials.front();
    glass.thickness = glass.attenuation_distance = 0.5f * wall;
    glass.attenuation_color = glm::vec3(float(kFaceOn));
    return scene;
}

Camera camera_of(const Scene& scene, float fov) {
    return orbit_camera(scene_bounds(scene), 0.0f, kElevation, framing_distance(fov, kShare), fov);
}

/// A plane of black and white squares across the view axis, `distance` from the eye.
void add_backdrop(Scene& scene, const Camera& camera, float distance) {
    constexpr int kSquares = 32;
    const float edge = 8.0f * scene_bounds(scene).radius / kSquares;
    Mesh plane;
    for (int i = 0; i < kSquares * kSquares; ++i) {
        const int x = i % kSquares, y = i / kSquares;
        const auto first = std::uint32_t(plane.positions.size());
        for (const glm::ivec2 corner : {glm::ivec2(0, 0), glm::ivec2(1, 0), glm::ivec2(1, 1), glm::ivec2(0, 1)})
            plane.positions.emplace_back(edge * (glm::vec2(x, y) + glm::vec2(corner) - 0.5f * kSquares), 0.0f);
        plane.colors.insert(plane.colors.end(), 4, glm::vec4(glm::vec3((x + y) % 2 == 0 ? 0.8f : 0.1f), 1.0f));
        plane.triangles.emplace_back(first, first + 1, first + 2);
        plane.triangles.emplace_back(first, first + 2, first + 3);
    }
    plane.normals.assign(plane.positions.size(), {0.0f, 0.0f, 1.0f});
    Material paper;
    paper.unlit = true;
    Object object;
    object.mesh = int(scene.meshes.size());
    object.material = int(scene.materials.size());
    object.world_from_object = glm::translate(camera.world_from_view, {0.0f, 0.0f, -distance});
    scene.meshes.push_back(std::move(plane));
    scene.materials.push_back(paper);
    scene.objects.push_back(object);
}

/// A form of the paper's transparency.
struct Form {
    std::string label;
    ParameterMap parameters;
};

std::vector<Form> forms() {
    std::vector<Form> all{{"linear", {{"mode", 0.0}, {"max-transparency", kFaceOn}}}};
    for (const int power : {1, 2, 3})
        all.push_back(
            {fmt::format("power {}", power), {{"mode", 1.0}, {"power", double(power)}, {"max-transparency", kFaceOn}}});
    all.push_back({"refraction, T^d", {{"mode", 2.0}, {"own-slabs", 1.0}}});
    return all;
}

RenderResult draw(ExperimentRun& run, const std::string& technique, const ParameterMap& parameters) {
    RenderSettings settings;
    settings.width = run.width;
    settings.height = run.height;
    settings.technique = technique;
    settings.parameters = parameters;
    settings.samples = 4;
    settings.paths = true;
    return run.renderer.render(settings);
}

std::vector<RefractedPath> exact_paths(ExperimentRun& run, const Camera& camera) {
    return run.renderer.tracer().exact(camera, {.width = run.width, .height = run.height});
}

/// Exact paths through glass that end.
bool counts(const RefractedPath& path) { return path.events > 0 && path.status == Status::kOk; }

/// Transparency of the form and that of the exact path's length in glass, over the pixels that both finish.
void add_transparency(nlohmann::ordered_json& json, const std::vector<RefractedPath>& exact,
                      const std::vector<RefractedPath>& paths, float sigma) {
    std::vector<double> errors;
    double sum = 0.0, exact_sum = 0.0, length = 0.0, exact_length = 0.0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        if (!counts(exact[i]) || !counts(paths[i])) continue;
        const double wanted = std::exp(-double(sigma) * exact[i].length_inside);
        const double found = paths[i].transmittance.g;
        errors.push_back(std::abs(found - wanted));
        sum += found;
        exact_sum += wanted;
        length += paths[i].length_inside;
        exact_length += exact[i].length_inside;
    }
    json["pixels"] = errors.size();
    if (errors.empty()) return;
    const double count = double(errors.size());
    double error_sum = 0.0;
    for (const double error : errors) error_sum += error;
    json["exact_transparency"] = exact_sum / count;
    json["transparency"] = sum / count;
    json["error"] = error_sum / count;
    json["relative_error"] = error_sum / exact_sum;
    json["median"] = spread(errors).median;
    json["p95"] = spread(errors).p95;
    if (length > 0.0) json["length_ratio"] = length / exact_length;
}

void measure_transparency(ExperimentRun& run, const ExperimentSpec& spec, ModelFolder&, ExperimentPage& page) {
    struct Figure {
        const char* label;
        const char* shape;
        float wall;
    };
    run.renderer.set_environment(load_environment(spec.environment));
    for (const Figure& figure : {Figure{"vase", "vase", 0.04f},
                                 {"thick vase", "vase", 0.12f},
                                 {"thick half vase", "vase,half=1", 0.12f},
                                 {"champagne glass, thin", "goblet", 0.01f}}) {
        Scene scene = vessel(figure.shape, figure.wall);
        const float sigma = scene.materials.front().sigma_a().g;
        const Camera camera = camera_of(scene, Camera{}.vertical_fov);
        add_backdrop(scene, camera,
                     scene_bounds(scene).radius * (kBackdrop + framing_distance(camera.vertical_fov, kShare)));
        run.renderer.set_scene(scene);
        run.renderer.set_camera(camera);
        const std::vector<RefractedPath> exact = exact_paths(run, camera);
        page.add_picture(figure.label, spec.truth.label, draw(run, spec.truth.technique, {}).display);
        for (const Form& form : forms()) {
            const RenderResult result = draw(run, kKayGreenberg, form.parameters);
            page.add_picture(figure.label, form.label, result.display);
            nlohmann::ordered_json json{{"scene", figure.label}, {"variant", form.label},
                                        {"width", run.width},    {"height", run.height},
                                        {"wall_m", figure.wall}, {"triangles", scene.triangle_count()}};
            add_transparency(json, exact, result.paths, sigma);
            run.console.print("{:<24} {:<18} {:>9.4f}\n", figure.label, form.label, json.value("error", 0.0));
            run.runs.push_back(std::move(json));
        }
    }
}

/// A plane across the view axis, and its unit: the glass's radius.
struct Backdrop {
    glm::vec3 point, axis;
    float radius;  ///< m
};

/// Distance of the points where two paths meet the plane, radii; infinite if one does not.
double miss(const Backdrop& plane, const RefractedPath& a, const RefractedPath& b) {
    const auto meet = [&](const RefractedPath& path) {
        const float approach = glm::dot(path.direction, plane.axis);
        if (approach <= 0.0f) return glm::vec3(std::numeric_limits<float>::infinity());
        return path.position + path.direction * (glm::dot(plane.point - path.position, plane.axis) / approach);
    };
    const double distance = double(glm::distance(meet(a), meet(b))) / double(plane.radius);
    return std::isfinite(distance) ? distance : std::numeric_limits<double>::infinity();
}

constexpr double kNear = 0.05;                      // radii
constexpr float kDistances[] = {0.0f, 1.0f, 4.0f};  // of the background behind the bounding sphere, radii

void add_misses(nlohmann::ordered_json& json, const Backdrop& plane, float distance,
                const std::vector<RefractedPath>& exact, const std::vector<RefractedPath>& paths) {
    std::vector<double> misses;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        if (!counts(exact[i])) continue;
        misses.push_back(counts(paths[i]) ? miss(plane, exact[i], paths[i]) : std::numeric_limits<double>::infinity());
    }
    json["pixels"] = misses.size();
    if (misses.empty()) return;
    const auto near = std::count_if(misses.begin(), misses.end(), [](double each) { return each < kNear; });
    const std::string at = fmt::format("at_{}", distance);
    const double median = spread(misses).median;
    json[at] = {{"near", double(near) / double(misses.size())}};
    if (std::isfinite(median)) json[at]["median"] = median;
}

void measure_background(ExperimentRun& run, const ExperimentSpec& spec, ModelFolder&, ExperimentPage& page) {
    run.renderer.set_environment(load_environment(spec.environment));
    const std::vector<Form> all = forms();
    for (const float wall : {0.01f, 0.04f, 0.12f}) {
        const Scene scene = vessel("vase", wall);
        run.renderer.set_scene(scene);
        const Bounds bounds = scene_bounds(scene);
        for (const int fov_deg : {1, 15, 30, 60, 90}) {
            const Camera camera = camera_of(scene, glm::radians(float(fov_deg)));
            run.renderer.set_camera(camera);
            const std::vector<RefractedPath> exact = exact_paths(run, camera);
            const std::string label = fmt::format("wall {} m, {} degrees", wall, fov_deg);
            page.add_picture(label, spec.truth.label, draw(run, spec.truth.technique, {}).display);
            for (const Form* form : {&all.front(), &all.back()}) {
                const RenderResult result = draw(run, kKayGreenberg, form->parameters);
                page.add_picture(label, form->label, result.display);
                nlohmann::ordered_json json{{"scene", label},       {"variant", form->label}, {"width", run.width},
                                            {"height", run.height}, {"wall_m", wall},         {"fov_deg", fov_deg}};
                const glm::vec3 axis = -glm::vec3(camera.world_from_view[2]);
                for (const float distance : kDistances)
                    add_misses(json, {bounds.center + (1.0f + distance) * bounds.radius * axis, axis, bounds.radius},
                               distance, exact, result.paths);
                run.console.print("{:<24} {:<18} {:>6.1f}%\n", label, form->label,
                                  100.0 * json["/at_0/near"_json_pointer].get<double>());
                run.runs.push_back(std::move(json));
            }
        }
    }
}

}  // namespace

ExperimentSpec kay_greenberg_transparency() {
    return {
        .name = "kay-greenberg-transparency",
        .source = "Kay and Greenberg 1979, sections 2 and 4, figures 1, 2 and 10 to 12",
        .varied = "vessel, and form of the transparency",
        .environment = "studio",
        .run = measure_transparency,
        .columns = {{"wall, m", "/wall_m", 1.0, 2},
                    {"pixels", "/pixels", 1.0, 0},
                    {"transparency, exact", "/exact_transparency", 1.0, 3},
                    {"transparency", "/transparency", 1.0, 3},
                    {"mean error", "/error", 1.0, 3},
                    {"of the exact, %", "/relative_error", 100.0, 1},
                    {"median error", "/median", 1.0, 3},
                    {"95% of errors below", "/p95", 1.0, 3},
                    {"length in glass, of the exact", "/length_ratio", 1.0, 2}},
        .plots = {{"Mean error of the transparency", "", false, {{"mean", "/error", 1.0, 3}}}},
        .remark =
            "Every form lets 0.9 through a surface seen from the front. Exact is T to the power of the exact path's "
            "length in glass, without Fresnel's losses. Each wall is two surfaces, so the paper's slabs have half "
            "of its thickness. Pixels: those whose paths both finish."};
}

ExperimentSpec kay_greenberg_background() {
    ExperimentSpec spec{
        .name = "kay-greenberg-background",
        .source = "Kay and Greenberg 1979, section 4.3: field of view, distance of the background, thickness",
        .varied = "wall of the vase, field of view, and displacement of the background",
        .environment = "checker",
        .size = {256, 256},
        .run = measure_background,
        .columns = {{"pixels", "/pixels", 1.0, 0}},
        .remark =
            "Distance between the points where the exact path and the technique's path meet a plane across the view "
            "axis, in radii of the vase's bounding sphere. The plane lies behind the sphere by the given number of "
            "radii. "
            "A path that misses the plane is not near. The form `linear` does not bend rays."};
    static const std::vector<std::array<std::string, 4>> texts = [] {
        std::vector<std::array<std::string, 4>> all;
        for (const float distance : kDistances)
            all.push_back({fmt::format("within {} of exact at {}, %", kNear, distance),
                           fmt::format("/at_{}/near", distance), fmt::format("median at {}", distance),
                           fmt::format("/at_{}/median", distance)});
        return all;
    }();
    for (const auto& text : texts) {
        spec.columns.push_back({text[0].c_str(), text[1].c_str(), 100.0, 1});
        spec.columns.push_back({text[2].c_str(), text[3].c_str(), 1.0, 3});
    }
    return spec;
}

}  // namespace pellucid::cli
