#include "lab/experiment_run.h"

#include "lab/accuracy.h"
#include "lab/bench_timing.h"
#include "lab/experiment_scenes.h"
#include "options/progress_bar.h"

#include "report/worst_region.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>

namespace pellucid::cli {
namespace {

constexpr double kWorstSearches = 4.0;  // of a pixel: (3 + 1)(m + n), Wang 2014, section 4.4
constexpr std::uint32_t kSamples = 4;   // jittered frames per picture, as in compare

/// One view of one scene, and what its variants are held against.
struct ExperimentView {
    const ExperimentScene& scene;
    std::unique_ptr<const Scene> loaded;  ///< stays where it is: the tracers refer to it
    Camera camera;
    RenderSettings settings;  ///< without the technique
    ExactView exact;
    RenderResult truth;
    std::optional<TimedTracer> embree;
    std::uint32_t packet = 1;
    double exact_ms = 0.0;  ///< of one exact trace of the view

    TimedTrace trace() const {
        return {embree->tracer, camera, {.width = settings.width, .height = settings.height, .packet = packet}};
    }
};

/// Pictures that are looked at more closely when all of a scene are there.
struct CaptionedPicture {
    std::string caption;
    Image picture;
};

RenderSettings settings_for(const ExperimentView& view, const Variant& variant) {
    RenderSettings settings = view.settings;
    settings.technique = variant.technique;
    settings.parameters = variant.parameters;
    settings.samples = variant.samples.value_or(kSamples);
    settings.paths = true;
    return settings;
}

RenderResult draw(ExperimentRun& run, const ExperimentSpec& spec, const ExperimentView& view, const Variant& variant) {
    const Environment environment = load_environment(spec.environment);
    run.renderer.set_environment(variant.map_width ? resampled(environment, *variant.map_width) : environment);
    ProgressBar bar(run.console, fmt::format("{}: {}, {}", spec.name, view.scene.label, variant.label));
    RenderSettings settings = settings_for(view, variant);
    settings.progress = bar.progress();
    RenderResult result = run.renderer.render(settings);
    for (const std::string& warning : result.warnings)
        run.warnings.insert(fmt::format("{}: {}", view.scene.label, warning));
    return result;
}

void prepare_timing(ExperimentRun& run, ExperimentView& view) {
    const auto start = std::chrono::steady_clock::now();
    run.renderer.tracer().exact(view.camera, {.width = view.settings.width, .height = view.settings.height});
    view.exact_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    view.embree = build_timed(*view.loaded, run.threads);
    view.packet = fastest_packet(view.trace());
}

ExperimentView prepare_view(ExperimentRun& run, const ExperimentSpec& spec, const ExperimentScene& scene,
                            std::unique_ptr<const Scene> loaded) {
    run.warnings.insert(loaded->warnings.begin(), loaded->warnings.end());
    run.renderer.set_scene(*loaded);
    RenderSettings settings;
    settings.width = run.width;
    settings.height = run.height;
    const Camera camera = bench_camera(scene.how, *loaded, run.width, run.height);
    run.renderer.set_camera(camera);
    ProgressBar bar(run.console, fmt::format("{}: {}, exact", spec.name, scene.label));
    ExperimentView view{.scene = scene,
                        .loaded = std::move(loaded),
                        .camera = camera,
                        .settings = settings,
                        .exact = trace_exact_view(run.renderer.tracer(), camera, run.width, run.height,
                                                  ExactSettings{}.max_events, bar.progress()),
                        .truth = {},
                        .embree = {}};
    bar.clear();
    view.truth = draw(run, spec, view, spec.truth);
    if (spec.timed) prepare_timing(run, view);
    return view;
}

void add_times(nlohmann::ordered_json& json, ExperimentRun& run, const ExperimentSpec& spec, const ExperimentView& view,
               const Variant& variant) {
    RenderSettings settings = settings_for(view, variant);
    settings.paths = false;
    ProgressBar bar(run.console, fmt::format("{}: {}, {}, timed", spec.name, view.scene.label, variant.label));
    const AlternatingTimes times = time_alternately(run.renderer, settings, run.frames, view.trace(), bar.progress());
    const auto spread_of = [](const std::vector<double>& times_ms) {
        const Spread s = spread(times_ms);
        return nlohmann::ordered_json{{"median", s.median}, {"p95", s.p95}};
    };
    json["frames"] = times.frames_ms.size();
    json["frame_ms"] = spread_of(times.frames_ms);
    for (const auto& [name, times_ms] : times.passes_ms) json["passes"][name] = spread_of(times_ms);
    const double frame_ms = json["frame_ms"]["median"], embree_ms = spread(times.traces_ms).median;
    json["fps"] = 1000.0 / frame_ms;
    json["embree_ms"] = embree_ms;
    json["embree_packet"] = view.packet;
    json["ratio_embree"] = embree_ms / frame_ms;
    json["exact_ms"] = view.exact_ms;
}

/// Search steps of wang-2014's pixels, in searches of the thesis: m binary and n linear steps.
void add_steps(nlohmann::ordered_json& json, const ExperimentView& view, const std::vector<RefractedPath>& paths) {
    const double search = json["/parameters/steps"_json_pointer].get<double>() +
                          json["/parameters/binary-steps"_json_pointer].get<double>();
    std::vector<double> searches;
    double sum = 0.0;
    std::size_t beyond = 0;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (view.exact.covered[i] == 0) continue;
        searches.push_back(double(paths[i].length_inside) / search);
        sum += searches.back();
        beyond += searches.back() > kWorstSearches ? 1 : 0;
    }
    if (searches.empty()) return;
    const double count = double(searches.size());
    json["searches"] = {{"mean", sum / count},
                        {"p95", spread(searches).p95},
                        {"largest", *std::max_element(searches.begin(), searches.end())},
                        {"beyond_worst", double(beyond) / count}};
}

nlohmann::ordered_json measured(ExperimentRun& run, const ExperimentSpec& spec, const ExperimentView& view,
                                const Variant& variant, const RenderResult& result) {
    nlohmann::ordered_json json{{"scene", view.scene.label},
                                {"source", view.scene.how.scene},
                                {"variant", variant.label},
                                {"technique", variant.technique},
                                {"width", view.settings.width},
                                {"height", view.settings.height},
                                {"ior", view.loaded->materials.front().ior},
                                {"objects", view.loaded->objects.size()},
                                {"triangles", view.loaded->triangle_count()}};
    add_parameters(json, find_technique(variant.technique), variant.parameters);
    if (view.scene.how.distance) json["distance"] = *view.scene.how.distance;
    if (variant.map_width) json["map_width"] = *variant.map_width;
    const PathAccuracy accuracy = judge(view.exact, result.paths).accuracy;
    add_accuracy(json, view.exact, accuracy);
    const auto counts = variant.parameters.find("count-steps");
    if (counts != variant.parameters.end() && counts->second > 0.0) add_steps(json, view, result.paths);
    const bool any = accuracy.covered > 0;
    json["flip_mean"] = json["rmse"] = nullptr;
    if (any) {
        json["flip_mean"] = mean(flip_ldr(view.truth.display, result.display), view.exact.covered);
        json["rmse"] = rmse(view.truth.radiance, result.radiance, view.exact.covered);
    }
    if (spec.timed) add_times(json, run, spec, view, variant);
    return json;
}

void print_run(const Console& console, const nlohmann::ordered_json& run) {
    const auto cell = [&](const char* pointer, double scale, int width, int digits) {
        const nlohmann::ordered_json::json_pointer at(pointer);
        return run.contains(at) && run[at].is_number()
                   ? fmt::format("{:>{}.{}f}", scale * run[at].get<double>(), width, digits)
                   : fmt::format("{:>{}}", "-", width);
    };
    console.print("{:<24} {:<32} {} {} {} {}\n", run["scene"].get<std::string>(), run["variant"].get<std::string>(),
                  cell("/within_1deg", 100.0, 7, 2), cell("/within_1deg_stable", 100.0, 8, 2),
                  cell("/flip_mean", 1.0, 8, 4), cell("/frame_ms/median", 1.0, 9, 2));
}

/// A part of a picture, with every pixel as a square of pixels.
Image magnified(const Image& picture, const Region& region) {
    constexpr int kShown = 256;  // pixels, about
    const int factor = std::max(1, kShown / region.size);
    const int width = std::min(region.size, picture.width - region.x);
    const int height = std::min(region.size, picture.height - region.y);
    Image shown(width * factor, height * factor, picture.channels);
    for (int y = 0; y < shown.height; ++y)
        for (int x = 0; x < shown.width; ++x)
            std::copy_n(picture.at(region.x + x / factor, region.y + y / factor), picture.channels, shown.at(x, y));
    return shown;
}

/// The region where the first picture differs most from the truth behind glass, of all of them.
void add_zoom(const ExperimentView& view, const Variant& truth, const std::vector<CaptionedPicture>& pictures,
              ExperimentPage& page) {
    if (pictures.empty()) return;
    Image flip = flip_ldr(view.truth.display, pictures.front().picture);
    for (std::size_t i = 0; i < flip.pixels.size(); ++i) {
        if (view.exact.covered[i] == 0) flip.pixels[i] = 0.0f;
    }
    const std::optional<Region> worst = worst_region(flip);
    if (!worst) return;
    const std::string row = view.scene.label + ", magnified";
    page.add_picture(row, truth.label, magnified(view.truth.display, *worst));
    for (const CaptionedPicture& each : pictures) page.add_picture(row, each.caption, magnified(each.picture, *worst));
}

void run_scene(ExperimentRun& run, const ExperimentSpec& spec, const ExperimentScene& scene,
               const std::vector<Variant>& variants, ExperimentPage& page) {
    std::unique_ptr<const Scene> loaded;
    const auto load = [&] {
        Scene made = scene.make ? scene.make() : with_copies(load_scene(scene.how.source), scene.how.copies);
        for (Material& material : made.materials) material.ior = scene.ior.value_or(material.ior);
        if (scene.close_holes) close_holes(made);
        loaded = std::make_unique<const Scene>(std::move(made));
    };
    if (!run.unread.read(scene.label, load)) {
        run.warnings.insert(run.unread.errors().back());
        return;
    }
    const ExperimentView view = prepare_view(run, spec, scene, std::move(loaded));
    page.add_picture(scene.label, spec.truth.label, view.truth.display);
    std::vector<CaptionedPicture> pictures;
    std::optional<double> first_ms;
    for (const Variant& variant : variants) {
        RenderResult result = draw(run, spec, view, variant);
        nlohmann::ordered_json json = measured(run, spec, view, variant, result);
        if (spec.timed) {
            const double frame_ms = json["frame_ms"]["median"];
            if (first_ms) json["times_first_fps"] = *first_ms / frame_ms;
            first_ms = first_ms.value_or(frame_ms);
        }
        // What was published is of the last variant.
        if (&variant == &variants.back() && !scene.published.empty()) json["published"] = scene.published;
        print_run(run.console, json);
        run.runs.push_back(std::move(json));
        page.add_picture(scene.label, variant.label, result.display);
        if (variant.analysis) {
            RenderSettings settings = settings_for(view, variant);
            settings.view = View::kAnalysis;
            settings.samples = 1;
            settings.paths = false;
            page.add_picture(scene.label, variant.label + ", analysis", run.renderer.render(settings).display);
        }
        if (spec.zoom) pictures.push_back({variant.label, std::move(result.display)});
    }
    add_zoom(view, spec.truth, pictures, page);
}

bool is_registered(const std::string& name) {
    return std::any_of(techniques().begin(), techniques().end(),
                       [&](const TechniqueInfo* info) { return info->name == name; });
}

}  // namespace

std::vector<Variant> available_variants(const ExperimentSpec& spec, ExperimentRun& run) {
    std::vector<Variant> available;
    for (const Variant& variant : spec.variants) {
        std::string lacking = "this build does not have it";
        if (is_registered(variant.technique)) {
            lacking = run.renderer.lacking(find_technique(variant.technique));
            if (lacking.empty()) {
                available.push_back(variant);
                continue;
            }
            lacking = fmt::format("it needs {}", lacking);
        }
        run.warnings.insert(fmt::format("technique {} is left out: {}", variant.technique, lacking));
    }
    return available;
}

void run_experiment(ExperimentRun& run, const ExperimentSpec& spec, const std::vector<ExperimentScene>& scenes,
                    const std::vector<Variant>& variants, ExperimentPage& page) {
    run.console.print("{}\n{:<24} {:<32} {:>7} {:>8} {:>8} {:>9}\n", spec.name, "scene", "variant", "1 deg%", "stable%",
                      "FLIP", "frame ms");
    for (const ExperimentScene& scene : scenes) run_scene(run, spec, scene, variants, page);
}

}  // namespace pellucid::cli
