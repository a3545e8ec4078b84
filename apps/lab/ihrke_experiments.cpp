// Accuracy of the view rays of Ihrke et al., "Eikonal Rendering", 2007.
#include "lab/ihrke_experiments.h"

#include "lab/experiment_run.h"
#include "options/progress_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <utility>

namespace pellucid::cli {
namespace {

constexpr const char* kIhrke = "ihrke-2007";
constexpr double kIor = 1.5;
constexpr double kFinestStep = 0.0625;  // voxels; what steps are held against
constexpr int kStepResolution = 128;
constexpr double kStepSmoothing = 0.75;  // voxels

/// World directions per pixel; none where the pixel does not count.
using Directions = std::vector<std::optional<glm::dvec3>>;

/// Unit direction of the view ray through a pixel's centre, and where it starts.
std::pair<glm::dvec3, glm::dvec3> view_ray(const Camera& camera, const ExperimentRun& run, std::uint32_t x,
                                           std::uint32_t y) {
    const double pixel = 2.0 * std::tan(0.5 * double(camera.vertical_fov)) / run.height;
    const glm::dvec3 view((x + 0.5 - 0.5 * run.width) * pixel, (0.5 * run.height - y - 0.5) * pixel, -1.0);
    const glm::dmat4 world(camera.world_from_view);
    return {glm::dvec3(world[3]), glm::normalize(glm::dmat3(world) * view)};
}

/// Exit directions by Snell's law at the surface of a unit ball around the origin, where view rays meet it. What enters
/// leaves at the same angle: there is no total reflection.
Directions exact_directions(const Camera& camera, const ExperimentRun& run) {
    Directions directions;
    for (std::uint32_t y = 0; y < run.height; ++y) {
        for (std::uint32_t x = 0; x < run.width; ++x) {
            const auto [origin, direction] = view_ray(camera, run, x, y);
            const double b = glm::dot(origin, direction), discriminant = b * b - glm::dot(origin, origin) + 1.0;
            directions.emplace_back();
            if (discriminant <= 0.0) continue;
            const glm::dvec3 entry = origin + (-b - std::sqrt(discriminant)) * direction;
            const glm::dvec3 inside = glm::refract(direction, entry, 1.0 / kIor);
            const glm::dvec3 exit = glm::normalize(entry - 2.0 * glm::dot(entry, inside) * inside);
            directions.back() = glm::normalize(glm::refract(inside, -exit, kIor));
        }
    }
    return directions;
}

Directions shown_directions(const Image& aov, const Directions& counted) {
    Directions directions;
    for (std::size_t i = 0; i < counted.size(); ++i) {
        directions.emplace_back();
        const float* d = &aov.pixels[3 * i];
        if (counted[i]) directions.back() = glm::dvec3(d[0], d[1], d[2]);
    }
    return directions;
}

/// Angles between directions of the pixels that count, degrees.
std::vector<double> errors_deg(const Directions& exact, const Directions& shown) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        if (!exact[i]) continue;
        const double sine = glm::length(glm::cross(*exact[i], *shown[i]));
        errors.push_back(std::atan2(sine, glm::dot(*exact[i], *shown[i])) * 180.0 / std::numbers::pi);
    }
    return errors;
}

/// Adds the error under names that begin with `prefix`; null where no pixel counts.
void add_errors(nlohmann::ordered_json& json, const std::string& prefix, const std::vector<double>& errors) {
    double sum = 0.0, within_1 = 0.0, within_5 = 0.0;
    for (const double error : errors) {
        sum += error;
        within_1 += error <= 1.0 ? 1.0 : 0.0;
        within_5 += error <= 5.0 ? 1.0 : 0.0;
    }
    const double count = double(errors.size());
    for (const char* name : {"mean_deg", "median_deg", "within_1deg", "within_5deg"}) json[prefix + name] = nullptr;
    if (errors.empty()) return;
    json[prefix + "mean_deg"] = sum / count;
    json[prefix + "median_deg"] = spread(errors).median;
    json[prefix + "within_1deg"] = within_1 / count;
    json[prefix + "within_5deg"] = within_5 / count;
}

struct Integrator {
    const char* label;
    const char* key;    ///< in JSON
    double least_step;  ///< voxels, that is measured
};
/// By the technique's parameter `integrator`.
constexpr Integrator kIntegrators[] = {{"Euler", "euler", 0.015625},
                                       {"RK4", "rk4", 0.125},
                                       {"leapfrog", "leapfrog", 0.0625},
                                       {"Nystrom", "nystrom", 0.125}};
constexpr int kEuler = 0, kRk4 = 1;

struct RayRun {
    int resolution;    ///< voxels along a side of the box
    double smoothing;  ///< voxels
    int integrator;    ///< kIntegrators
    double step;       ///< voxels
    std::string variant() const { return fmt::format("{}, step {}", kIntegrators[integrator].label, step); }
};

/// The ball, and what its rays are held against.
struct Ball {
    Scene scene;
    Camera camera;
    Directions exact;
};

Ball prepare_ball(ExperimentRun& run, int resolution, double smoothing) {
    Ball ball;
    ball.scene = load_scene(
        fmt::format("volume:smoothed-sphere,resolution={},smoothing={},ior={}", resolution, smoothing, kIor));
    run.renderer.set_scene(ball.scene);
    // Of the ball rather than of its box, so that the view is the same for all.
    const Bounds unit{.center = glm::vec3(0.0f), .radius = 1.0f, .half_size = glm::vec3(1.0f)};
    constexpr float kAzimuthDeg = 20.0f, kElevationDeg = 15.0f, kDistance = 5.5f;
    ball.camera = orbit_camera(unit, kAzimuthDeg, kElevationDeg, kDistance, Camera{}.vertical_fov);
    run.renderer.set_camera(ball.camera);
    ball.exact = exact_directions(ball.camera, run);
    return ball;
}

RenderResult draw(ExperimentRun& run, const RayRun& how, std::uint32_t samples) {
    // Four sides of the box: the few rays that long steps catch along the surface must not count for all of a frame's time.
    const double max_steps = std::clamp(std::ceil(4.0 * how.resolution / how.step), 1.0, 60000.0);
    RenderSettings settings;
    settings.width = run.width;
    settings.height = run.height;
    settings.technique = kIhrke;
    settings.parameters = {
        {"interpolation", 0.0}, {"integrator", double(how.integrator)}, {"step", how.step}, {"max-steps", max_steps}};
    settings.samples = samples;
    settings.still = false;
    settings.aovs = {"exit-direction"};
    RenderResult result = run.renderer.render(settings);
    run.warnings.insert(result.warnings.begin(), result.warnings.end());
    return result;
}

/// Median over the frames of the time of all passes, ms.
double median_frame_ms(const RenderResult& result) {
    std::vector<double> times_ms;
    for (const std::vector<PassTime>& frame : result.frames) {
        double sum = 0.0;
        for (const PassTime& pass : frame) sum += pass.time_ms;
        times_ms.push_back(sum);
    }
    return spread(std::move(times_ms)).median;
}

/// What an error costs.
struct Cost {
    double error_deg, step, frame_ms;
};

/// Between two of `costs`, whose errors fall, along a line of logarithms; none: the error lies outside of them.
std::optional<Cost> at_error(const std::vector<Cost>& costs, double error_deg) {
    for (std::size_t i = 1; i < costs.size(); ++i) {
        const Cost &a = costs[i - 1], &b = costs[i];
        if (error_deg > a.error_deg || error_deg < b.error_deg || b.error_deg <= 0.0) continue;
        const double t = std::log(a.error_deg / error_deg) / std::log(a.error_deg / b.error_deg);
        return Cost{error_deg, a.step * std::pow(b.step / a.step, t),
                    a.frame_ms * std::pow(b.frame_ms / a.frame_ms, t)};
    }
    return std::nullopt;
}

nlohmann::ordered_json run_of(const ExperimentRun& run, const std::string& scene, const RayRun& how, const Ball& ball) {
    const auto covered = std::count_if(ball.exact.begin(), ball.exact.end(), [](const auto& d) { return bool(d); });
    return {{"scene", scene},
            {"variant", how.variant()},
            {"technique", kIhrke},
            {"width", run.width},
            {"height", run.height},
            {"resolution", how.resolution},
            {"smoothing", how.smoothing},
            {"integrator", kIntegrators[how.integrator].key},
            {"step", how.step},
            {"covered", covered}};
}

void finish_run(ExperimentRun& run, nlohmann::ordered_json json) {
    const auto number = [&](const char* name) {
        return json.contains(name) && json[name].is_number() ? fmt::format("{:>9.4f}", json[name].get<double>())
                                                             : fmt::format("{:>9}", "-");
    };
    run.console.print("{:<28} {:<20} {} {} {} {}\n", json["scene"].get<std::string>(),
                      json["variant"].get<std::string>(), number("mean_deg"), number("median_deg"),
                      number("converged_mean_deg"), number("frame_ms"));
    run.runs.push_back(std::move(json));
}

std::string label_of(int resolution, double smoothing) {
    return fmt::format("{} voxels, smoothing {}", resolution, smoothing);
}

/// Resolutions and smoothing against the surface.
void measure_surface(ExperimentRun& run, ExperimentPage& page) {
    for (const int resolution : {64, 128, 256}) {
        for (const double smoothing : {0.5, 0.75, 1.0}) {
            const RayRun how{resolution, smoothing, kRk4, 0.5};
            const Ball ball = prepare_ball(run, resolution, smoothing);
            const std::string scene = label_of(resolution, smoothing);
            const RenderResult result = draw(run, how, 1);
            nlohmann::ordered_json json = run_of(run, scene, how, ball);
            add_errors(json, "",
                       errors_deg(ball.exact, shown_directions(result.aovs.at("exit-direction"), ball.exact)));
            if (smoothing == kStepSmoothing)
                page.add_picture("ball", fmt::format("{} voxels", resolution), result.display);
            finish_run(run, std::move(json));
        }
    }
}

/// Steps of the integrators in one volume, against the surface and against steps that are much shorter.
void measure_steps(ExperimentRun& run, const ExperimentSpec& spec) {
    const Ball ball = prepare_ball(run, kStepResolution, kStepSmoothing);
    const std::string scene = "steps, " + label_of(kStepResolution, kStepSmoothing);
    const RenderResult finest = draw(run, {kStepResolution, kStepSmoothing, kRk4, kFinestStep}, 1);
    const Directions converged = shown_directions(finest.aovs.at("exit-direction"), ball.exact);
    std::vector<Cost> euler;
    for (int integrator = 0; integrator < int(std::size(kIntegrators)); ++integrator) {
        for (double step = 2.0; step >= kIntegrators[integrator].least_step; step /= 2.0) {
            const RayRun how{kStepResolution, kStepSmoothing, integrator, step};
            ProgressBar bar(run.console, fmt::format("{}: {}", spec.name, how.variant()));
            const RenderResult result = draw(run, how, std::uint32_t(std::max(2, run.frames)));
            bar.clear();
            const Directions shown = shown_directions(result.aovs.at("exit-direction"), ball.exact);
            nlohmann::ordered_json json = run_of(run, scene, how, ball);
            add_errors(json, "", errors_deg(ball.exact, shown));
            add_errors(json, "converged_", errors_deg(converged, shown));
            if (!result.frames.empty()) {
                json["frames"] = result.frames.size();
                json["frame_ms"] = median_frame_ms(result);
            }
            if (!json["converged_mean_deg"].is_null() && json.contains("frame_ms")) {
                const Cost cost{json["converged_mean_deg"], step, json["frame_ms"]};
                if (integrator == kEuler)
                    euler.push_back(cost);
                else if (const std::optional<Cost> equal = at_error(euler, cost.error_deg))
                    json["euler_at_equal_error"] = {{"step", equal->step},
                                                    {"frame_ms", equal->frame_ms},
                                                    {"times_as_long", equal->frame_ms / cost.frame_ms}};
            }
            finish_run(run, std::move(json));
        }
    }
}

void measure_rays(ExperimentRun& run, const ExperimentSpec& spec, ModelFolder&, ExperimentPage& page) {
    run.console.print("{}\n{:<28} {:<20} {:>9} {:>9} {:>9} {:>9}\n", spec.name, "scene", "variant", "mean", "median",
                      "converged", "frame ms");
    measure_surface(run, page);
    measure_steps(run, spec);
}

}  // namespace

ExperimentSpec ihrke_rays() {
    return {.name = "ihrke-rays",
            .source = "Ihrke et al. 2007, section 4.1: view rays through a smoothed ball of index 1.5",
            .varied = "voxels, smoothing (voxels), and integrator and step (voxels)",
            .size = {128, 128},
            .truth = {"refraction at the ball's surface", "reference"},
            .run = measure_rays,
            .columns = {{"pixels", "/covered", 1.0, 0},
                        {"mean error, degrees", "/mean_deg", 1.0, 3},
                        {"median, degrees", "/median_deg", 1.0, 3},
                        {"within 1 degree, %", "/within_1deg", 100.0, 1},
                        {"within 5 degrees, %", "/within_5deg", 100.0, 1},
                        {"from converged: mean, degrees", "/converged_mean_deg", 1.0, 4},
                        {"from converged: median, degrees", "/converged_median_deg", 1.0, 4},
                        {"frame, ms", "/frame_ms"},
                        {"Euler at equal error: step, voxels", "/euler_at_equal_error/step", 1.0, 4},
                        {"Euler at equal error: frame, ms", "/euler_at_equal_error/frame_ms"},
                        {"Euler at equal error: times as long", "/euler_at_equal_error/times_as_long", 1.0, 2}},
            .remark =
                "Angles of exit directions over all pixels whose view ray meets the ball. Converged: RK4 in steps of "
                "1/16 voxel through the same volume, linearly interpolated as in the paper, which leaves the error of "
                "the integrator alone. Euler at equal error: "
                "between the two of its steps whose errors are next, by logarithms."};
}

}  // namespace pellucid::cli
