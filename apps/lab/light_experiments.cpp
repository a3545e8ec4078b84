// Light through volumes of varying index (Ihrke et al. 2007, section 4.2), measured.
#include "lab/light_experiments.h"

#include "lab/experiment_run.h"
#include "lab/landed_light.h"
#include "options/progress_bar.h"

#include <pellucid/volume_light.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

namespace pellucid::cli {
namespace {

constexpr int kRepetitions = 3;
constexpr int kPhotonRings = 2500;
constexpr glm::vec3 kWay(0.2f, -1.0f, 0.1f);  // of the light
constexpr float kHalf = 2.5f;                 // edge of the ground, m

Scene lit_volume(const std::string& spec, float ground) {
    Scene scene;
    scene.source = spec;
    scene.volumes.push_back(std::make_shared<const Volume>(make_volume(spec)));
    scene.volume_objects.emplace_back();
    scene.materials.emplace_back();
    Mesh plane;
    plane.positions = {
        {-kHalf, ground, kHalf}, {kHalf, ground, kHalf}, {kHalf, ground, -kHalf}, {-kHalf, ground, -kHalf}};
    plane.normals.assign(4, {0.0f, 1.0f, 0.0f});
    plane.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.meshes.push_back(plane);
    scene.objects.emplace_back();
    Light sun;
    sun.kind = Light::Kind::kDirectional;
    sun.direction = glm::normalize(kWay);
    scene.lights.push_back(sun);
    return scene;
}

double sum(glm::dvec3 power) { return power.x + power.y + power.z; }

/// Traces, and appends a run; `more` adds to it.
MeasuredLight measure(ExperimentRun& run, const std::string& scene_name, const std::string& variant, const Scene& scene,
                      const LightSettings& settings, nlohmann::ordered_json& json, int repetitions = kRepetitions) {
    const DeviceOptions options{.device = run.renderer.device().name, .validation = false};
    ProgressBar bar(run.console, fmt::format("{}, {}", scene_name, variant));
    MeasuredLight light = measure_light(options, scene, settings, repetitions);
    bar.clear();
    const LightStatistics& s = light.statistics;
    for (const std::string& warning : s.warnings()) run.warnings.insert(fmt::format("{}: {}", variant, warning));
    const double emitted = sum(s.emitted);
    json = {{"scene", scene_name},
            {"variant", variant},
            {"patches", s.patches},
            {"splits", s.splits},
            {"rounds", s.rounds},
            {"light_ms", light.device_ms},
            {"wall_ms", light.wall_ms},
            {"arrived", sum(s.arrived) / emitted},
            {"missed", sum(s.missed) / emitted},
            {"reflected", sum(s.reflected) / emitted},
            {"absorbed", sum(s.absorbed) / emitted},
            {"turned", sum(s.turned) / emitted},
            {"weak", sum(s.weak) / emitted},
            {"left", sum(s.left) / emitted}};
    run.console.print("{:<14} {:<32} {:>9.1f} ms {:>9} patches {:>9} splits, left {:.3f}%\n", scene_name, variant,
                      light.device_ms, s.patches, s.splits, 100.0 * sum(s.left) / emitted);
    return light;
}

Image display(const std::vector<double>& map, int width, int height) {
    Image image(width, height, 3);
    for (std::size_t i = 0; i < map.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            image.pixels[3 * i + c] = float(std::pow(std::min(map[i] / 8.0, 1.0), 1.0 / 2.2));  // 8 times the light
    return image;
}

/// A way to trace light that the experiment compares.
struct LightVariant {
    const char* name;
    KeptLight kept;
    bool folds;
};
constexpr LightVariant kLightVariants[] = {{"sum, folds kept", KeptLight::kSum, true},
                                           {"brightest, folds kept", KeptLight::kBrightest, true},
                                           {"brightest, folds dropped", KeptLight::kBrightest, false}};

void measure_ball(ExperimentRun& run, ExperimentPage& page) {
    for (const int resolution : {32, 64, 128}) {
        const Scene scene = lit_volume(fmt::format("smoothed-sphere,radius=1,resolution={}", resolution), -1.4f);
        const std::string name = fmt::format("ball, {}", resolution);
        std::vector<double> exact;
        for (const LightVariant& variant : kLightVariants) {
            LightSettings settings;
            settings.fresnel = false;  // as the photons
            settings.kept = variant.kept;
            settings.keep_folds = variant.folds;
            nlohmann::ordered_json json;
            const MeasuredLight light = measure(run, name, variant.name, scene, settings, json);
            BallAndPlane truth{.box = double(scene.volumes[0]->high().x),
                               .direction = glm::normalize(glm::dvec3(kWay))};
            set_level_map(truth, double(kHalf), -1.4, light.voxel);
            if (exact.empty()) exact = count_photons(truth, kPhotonRings);
            const std::vector<double> own = landed_map(light.photons, truth);
            const glm::dvec3 foot = -1.4 / truth.direction.y * truth.direction - truth.corner;
            const glm::dvec2 around = glm::dvec2(glm::dot(foot, truth.side), glm::dot(foot, truth.up)) / truth.texel;
            const CausticSpot spot = caustic_spot(own, truth.width, around, 0.9 / truth.texel),
                              wanted = caustic_spot(exact, truth.width, around, 0.9 / truth.texel);
            const double voxels = truth.texel / light.voxel;
            json["center_off"] = voxels * glm::distance(spot.center, wanted.center);
            json["radius"] = voxels * spot.radius;
            json["exact_radius"] = voxels * wanted.radius;
            json["correlation"] = correlation(own, exact);
            run.runs.push_back(json);
            if (resolution != 128) continue;
            if (&variant == kLightVariants)
                page.add_picture(name, "counted photons", display(exact, truth.width, truth.height));
            page.add_picture(name, json["variant"], display(own, truth.width, truth.height));
        }
    }
}

void measure_glass(ExperimentRun& run, ExperimentPage& page) {
    const std::string glass = "wine-glass,resolution=128";
    const float low = make_volume(glass).low.y;
    const Scene standing = lit_volume(glass, low + 0.04f);  // its foot on the plane
    for (const LightVariant& variant : kLightVariants) {
        LightSettings settings;
        settings.kept = variant.kept;
        settings.keep_folds = variant.folds;
        settings.reflections = 0;
        nlohmann::ordered_json json, counted;
        const MeasuredLight light = measure(run, "wine glass, 128", variant.name, standing, settings, json);
        if (variant.kept == KeptLight::kBrightest) {
            settings.tally = true;
            const std::string name = fmt::format("{}, counted", variant.name);
            const LightStatistics s = measure(run, "wine glass, 128", name, standing, settings, counted).statistics;
            json["lit_voxels"] = s.lit_voxels;
            json["multi_share"] = double(s.multi_voxels) / double(std::max<std::uint64_t>(s.lit_voxels, 1));
            json["main_share"] = s.main_share;
        }
        run.runs.push_back(json);
        BallAndPlane ground;
        set_level_map(ground, double(kHalf), double(low) + 0.04, light.voxel);
        page.add_picture("wine glass, 128", variant.name,
                         display(landed_map(light.photons, ground), ground.width, ground.height));
    }
}

/// What it costs to follow the light that surfaces reflect.
void measure_reflections(ExperimentRun& run) {
    for (const std::string spec : {"smoothed-sphere,radius=1,resolution=128", "wine-glass,resolution=128"}) {
        const bool ball = spec.starts_with("smoothed");
        const Scene scene = lit_volume(spec, ball ? -1.4f : make_volume(spec).low.y + 0.04f);
        for (const std::uint32_t reflections : {0u, 1u}) {
            LightSettings settings;
            settings.reflections = reflections;
            nlohmann::ordered_json json;
            measure(run, ball ? "ball, 128" : "wine glass, 128", fmt::format("sum, {} reflections", reflections), scene,
                    settings, json, 1);
            run.runs.push_back(json);
        }
    }
}

double apart(const std::vector<double>& map, const std::vector<double>& truth) {
    double differences = 0.0, all = 0.0;
    for (std::size_t i = 0; i < map.size(); ++i) differences += std::abs(map[i] - truth[i]), all += truth[i];
    return differences / all;
}

/// The caustic of a smoothed ball by wavefronts, and by as many photons as one thread traces in the time of an update:
/// those of the truth, whose photons of one ring share an integration, and as many as there would be were each integrated.
void compare_with_photons(ExperimentRun& run) {
    const std::string name = "smoothed ball, 128";
    const Scene scene = lit_volume("smoothed-sphere,radius=1,resolution=128", -1.4f);
    LightSettings settings;
    settings.fresnel = false;
    nlohmann::ordered_json json;
    const MeasuredLight light = measure(run, name, "sum, folds kept", scene, settings, json, 1);
    BallAndPlane ball{.smoothing = 0.75 * light.voxel,
                      .box = double(scene.volumes[0]->high().x),
                      .direction = glm::normalize(glm::dvec3(kWay))};
    set_level_map(ball, double(kHalf), -1.4, light.voxel);
    const std::vector<double> own = landed_map(light.photons, ball);
    std::vector<double> counted;
    const auto count = [&](int rings) {
        const auto start = std::chrono::steady_clock::now();
        counted = count_photons(ball, rings);
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    };
    // A ring is integrated once, and has 2 pi photons for each ring inside it.
    const double few = 200.0, many = 3000.0, few_ms = count(int(few)), many_ms = count(int(many));
    const std::vector<double> truth = counted;
    const double ratio = many / few, square = std::numbers::pi * many * many;
    const double photon_ms = (many_ms - ratio * few_ms) / (square * (1.0 - 1.0 / ratio));
    const double ring_ms = (many_ms - square * photon_ms) / many;
    const auto add = [&](const char* variant, double rings, double ms, const std::vector<double>& found) {
        json = {{"scene", name},
                {"variant", variant},
                {"light_ms", ms},
                {"apart", apart(found, truth)},
                {"correlation", correlation(found, truth)}};
        if (rings > 0.0) json["photons"] = std::numbers::pi * rings * rings;
        run.console.print("{:<18} {:<40} {:>9.1f} ms, {:.0f} rings, apart {:.4f}\n", name, variant, ms, rings,
                          apart(found, truth));
        run.runs.push_back(json);
    };
    add("wavefronts", 0.0, light.device_ms, own);
    const double half = 0.5 * ring_ms / (std::numbers::pi * photon_ms);
    const double by_rings = std::sqrt(half * half + light.device_ms / (std::numbers::pi * photon_ms)) - half;
    const double each = std::sqrt(light.device_ms / (ring_ms + photon_ms) / std::numbers::pi);
    for (const auto& [variant, rings] :
         {std::pair("photons by rings, same time", by_rings), std::pair("photons each by itself, same time", each)}) {
        count(std::max(1, int(rings)));
        add(variant, rings, light.device_ms, counted);
    }
}

void measure_lights(ExperimentRun& run, const ExperimentSpec&, ModelFolder&, ExperimentPage& page) {
    measure_ball(run, page);
    measure_glass(run, page);
}

void measure_more(ExperimentRun& run, const ExperimentSpec&, ModelFolder&, ExperimentPage&) {
    compare_with_photons(run);
    measure_reflections(run);
}

}  // namespace

ExperimentSpec ihrke_light() {
    return {.name = "ihrke-light",
            .source =
                "Ihrke 2007, sections 4.2 and 6: light in volumes; 5.6% of the voxels get light from several "
                "directions, of which the strongest carries 81.6%; 5 to 10 s per update of the light",
            .varied = "the volume, its grid, and what becomes of light past a focus",
            .truth = {"counted photons", "reference"},
            .run = measure_lights,
            .columns = {{"light, ms", "/light_ms"},
                        {"host and device, ms", "/wall_ms"},
                        {"patches at once", "/patches", 1.0, 0},
                        {"splits", "/splits", 1.0, 0},
                        {"on the plane, %", "/arrived", 100.0, 2},
                        {"reflected, %", "/reflected", 100.0, 2},
                        {"dropped at folds, %", "/turned", 100.0, 2},
                        {"never out, %", "/left", 100.0, 2},
                        {"centre off, voxels", "/center_off", 1.0, 3},
                        {"half-power radius, voxels", "/radius", 1.0, 2},
                        {"exact", "/exact_radius", 1.0, 2},
                        {"correlation", "/correlation", 1.0, 4},
                        {"voxels lit from several directions, %", "/multi_share", 100.0, 2},
                        {"of it, the strongest, %", "/main_share", 100.0, 2}},
            .remark =
                "The caustic of a ball of index 1.5, radius 1 m, on a plane 1.4 m below its middle, against "
                "2,500 rings of photons through the exact ball; without reflections, which they have not either. Light "
                "from several directions: over 1% of what passes a voxel goes more than 15 degrees off the "
                "brightest. Times are medians of three."};
}

ExperimentSpec ihrke_reflections() {
    return {
        .name = "ihrke-reflections",
        .source = "Ihrke 2007, section 4.2: light in volumes, against photons, and with the light that is reflected",
        .varied = "what traces light, and how many reflections are followed",
        .truth = {"counted photons", "reference"},
        .run = measure_more,
        .columns = {{"light, ms", "/light_ms"},
                    {"patches at once", "/patches", 1.0, 0},
                    {"photons", "/photons", 1.0, 0},
                    {"sum of differences, %", "/apart", 100.0, 2},
                    {"correlation", "/correlation", 1.0, 4},
                    {"on the plane, %", "/arrived", 100.0, 2},
                    {"missed, %", "/missed", 100.0, 2},
                    {"reflected, %", "/reflected", 100.0, 2},
                    {"never out, %", "/left", 100.0, 2}},
        .remark =
            "The caustic of a smoothed ball against 3,000 rings of photons through the same ball. Photons are "
            "traced by one thread, in double precision; wavefronts by as many as the device has. Times are of "
            "one update."};
}

}  // namespace pellucid::cli
