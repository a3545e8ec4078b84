#include "lab/accuracy.h"
#include "lab/commands.h"
#include "lab/compare_options.h"
#include "lab/image_truth.h"
#include "lab/thickness_compare.h"
#include "options/help.h"
#include "options/light_options.h"
#include "options/options.h"
#include "options/progress_bar.h"
#include "options/unread_scenes.h"

#include "report/report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>

namespace pellucid::cli {
namespace {

/// What stays the same from view to view, and where the results go.
struct Comparison {
    const CompareArguments& arguments;
    Renderer renderer;
    std::vector<NamedTechnique> techniques;
    ParameterMap parameters;
    RenderSettings settings;  ///< without the technique
    NamedTechnique truth;
    std::optional<Report> report;
    nlohmann::ordered_json json;
    std::set<std::string> warnings;
    UnreadScenes unread;
    TruthNoise noise = {};
};

/// One camera around one scene.
struct ComparedView {
    std::string scene;
    int index;
    OrbitView orbit;
    std::uint64_t triangles;
    ExactView exact;
    RenderSettings truth_settings;
    ImageTruth truth;
};

/// What one technique has drawn of a view.
struct Drawn {
    const NamedTechnique& technique;
    RenderSettings settings;
    RenderResult result;
    Judgement judgement;
};

double median_frame_ms(const RenderResult& result) {
    std::vector<double> totals;
    for (const auto& frame : result.frames) {
        double total = 0.0;
        for (const PassTime& pass : frame) total += pass.time_ms;
        totals.push_back(total);
    }
    return spread(totals).median;
}

/// Exact paths are as long everywhere as those that the techniques are held against.
RenderSettings settings_for(const Comparison& comparison, const NamedTechnique& technique) {
    RenderSettings settings = comparison.settings;
    settings.technique = technique.name;
    ParameterMap parameters = comparison.parameters;
    if (technique.info().reference) parameters.try_emplace("events", double(comparison.arguments.exact_events));
    settings.parameters = parameters_of(technique, parameters);
    return settings;
}

RenderSettings settings_of_truth(const Comparison& comparison, const NamedTechnique& truth) {
    RenderSettings settings = settings_for(comparison, truth);
    if (truth.info().all_light) settings.samples = comparison.arguments.truth_samples.value_or(kTruthSamples);
    return settings;
}

NamedTechnique truth_named(const std::string& name) { return {name, {&find_technique(name), {}}}; }

/// What draws the picture that the others are held against: `reference` traces volumes, but draws none.
NamedTechnique truth_for(Comparison& comparison, const std::string& name, const Scene& scene) {
    if (scene.volume_objects.empty() || comparison.truth.info().volumes) return comparison.truth;
    comparison.warnings.insert(fmt::format("{}: pictures are held against those of path, as {} draws no volumes", name,
                                           comparison.truth.name));
    return truth_named("path");
}

void add_warnings(Comparison& comparison, const std::string& scene, const std::string& technique,
                  const RenderResult& result) {
    for (const std::string& warning : result.warnings) {
        const bool named = warning.starts_with(technique + ": ");
        comparison.warnings.insert(fmt::format("{}: {}{}", scene, named ? "" : technique + ": ", warning));
    }
}

Drawn draw(Comparison& comparison, const ComparedView& view, const NamedTechnique& technique) {
    ProgressBar bar(comparison.arguments.console,
                    fmt::format("{}, view {}, {}", view.scene, view.index + 1, technique.name));
    RenderSettings settings = settings_for(comparison, technique);
    settings.paths = true;
    settings.progress = bar.progress();
    RenderResult result = comparison.renderer.render(settings);
    settings.progress = {};
    add_warnings(comparison, view.scene, technique.name, result);
    Judgement judgement = judge(view.exact, result.paths);
    result.paths = {};
    return {technique, settings, std::move(result), std::move(judgement)};
}

nlohmann::ordered_json describe(Comparison& comparison, const ComparedView& view, const Drawn& drawn) {
    const auto& [technique, drawn_settings, result, judgement] = drawn;
    RenderSettings settings = drawn_settings;
    const Image flip = flip_ldr(view.truth.result.display, result.display);
    nlohmann::ordered_json run{{"scene", view.scene}};
    add_technique(run, technique);
    run["view"] = view.index;
    run["camera"] = view.orbit.description();
    run["width"] = settings.width;
    run["height"] = settings.height;
    run["triangles"] = view.triangles;
    add_parameters(run, technique.info(), settings.parameters);
    if (view.truth.technique != comparison.truth.name) run["image_truth"] = view.truth.technique;
    run["truth_samples"] = view.truth.samples;
    if (view.truth.noise) run["truth_noise"] = *view.truth.noise;
    add_accuracy(run, view.exact, judgement.accuracy);
    if (judgement.accuracy.covered > 0) {
        run["flip_mean"] = mean(flip, view.exact.covered);
        run["rmse"] = rmse(view.truth.result.radiance, result.radiance, view.exact.covered);
    } else {
        run["flip_mean"] = run["rmse"] = nullptr;
    }
    if (!technique.info().reference && !result.frames.empty() && !result.frames.front().empty()) {
        run["frame_ms"] = median_frame_ms(result);
        run["frames"] = result.frames.size();
    }

    if (comparison.report) {
        const PictureOf of{view.scene, view.index, technique.name};
        comparison.report->add_picture(of, PictureKind::kImage, result.display);
        comparison.report->add_picture(of, PictureKind::kError, judgement.error_deg);
        comparison.report->add_picture(of, PictureKind::kFlip, flip);
        settings.view = View::kAnalysis;
        settings.samples = 1;
        settings.paths = false;
        comparison.report->add_picture(of, PictureKind::kAnalysis, comparison.renderer.render(settings).display);
    }
    return run;
}

ComparedView exact_view(Comparison& comparison, const std::string& name, const Scene& scene, int index) {
    const CompareArguments& arguments = comparison.arguments;
    RenderSettings settings = comparison.settings;
    const Bounds bounds = scene_bounds(scene);
    const OrbitView orbit = comparison_view(bounds, index, arguments.views, settings.width, settings.height);
    const Camera camera = orbit.camera(bounds);
    comparison.renderer.set_camera(camera);

    ProgressBar bar(arguments.console, fmt::format("{}, view {} of {}, exact", name, index + 1, arguments.views));
    ComparedView view{name,
                      index,
                      orbit,
                      scene.triangle_count(),
                      trace_exact_view(comparison.renderer.tracer(), camera, settings.width, settings.height,
                                       arguments.exact_events, bar.progress()),
                      {},
                      {}};
    bar.clear();
    view.truth_settings = settings_of_truth(comparison, truth_for(comparison, name, scene));
    ProgressBar truth_bar(arguments.console, fmt::format("{}, view {} of {}, {}", name, index + 1, arguments.views,
                                                         view.truth_settings.technique));
    settings = view.truth_settings;
    settings.progress = truth_bar.progress();
    view.truth = draw_truth(comparison.renderer, settings, view.exact.covered);
    add_warnings(comparison, name, settings.technique, view.truth.result);
    return view;
}

/// Draws the truth with more samples where the differences between techniques need them.
void reduce_noise(Comparison& comparison, ComparedView& view, const std::vector<Drawn>& all) {
    ProgressBar bar(comparison.arguments.console,
                    fmt::format("{}, view {}, {}, more samples", view.scene, view.index + 1, view.truth.technique));
    RenderSettings settings = view.truth_settings;
    settings.progress = bar.progress();
    std::vector<const Image*> images;
    for (const Drawn& drawn : all) images.push_back(&drawn.result.display);
    const std::uint32_t most = comparison.arguments.truth_samples ? view.truth.samples : kMostTruthSamples;
    comparison.noise.add_view(comparison.renderer, settings, view.exact.covered, images, most, view.truth);
}

void save(const Comparison& comparison) {
    if (!comparison.arguments.json) return;
    write_json(*comparison.arguments.json, comparison.json);
}

void print_comparison_head(const Console& console) {
    console.print("{:<28} {:>4} {:<22} {:>7} {:>7} {:>8} {:>7} {:>8}\n", "scene", "view", "technique", "1 deg%",
                  "5 deg%", "stable%", "median", "FLIP");
}

void print_row(const Console& console, const nlohmann::ordered_json& run) {
    const auto cell = [&](const char* key, double scale, int width, int digits) {
        const auto& value = run[key];
        return value.is_null() ? fmt::format("{:>{}}", "-", width)
                               : fmt::format("{:>{}.{}f}", scale * value.get<double>(), width, digits);
    };
    console.print("{:<28} {:>4} {:<22} {} {} {} {} {}\n", run["scene"].get<std::string>(), run["view"].get<int>(),
                  run["technique"].get<std::string>(), cell("within_1deg", 100.0, 7, 2),
                  cell("within_5deg", 100.0, 7, 2), cell("within_1deg_stable", 100.0, 8, 2),
                  cell("median_deg", 1.0, 7, 2), cell("flip_mean", 1.0, 8, 4));
}

/// What was warned of so far, once each.
std::set<std::string> all_warnings(const Comparison& comparison) {
    std::set<std::string> warnings = comparison.warnings;
    if (const std::optional<std::string> noise = comparison.noise.warning()) warnings.insert(*noise);
    return warnings;
}

/// Samples of the truth, or the fewest where the differences between techniques choose them.
std::uint32_t truth_samples(const CompareArguments& arguments) {
    const bool all_light = find_technique(arguments.truth).all_light;
    return all_light ? arguments.truth_samples.value_or(kTruthSamples) : arguments.samples;
}

std::string describe_truth(const CompareArguments& arguments, std::uint32_t most) {
    const std::uint32_t least = truth_samples(arguments);
    return fmt::format("{}, samples per pixel: {}{}", arguments.truth, least,
                       most > least ? fmt::format(" to {}", most) : "");
}

void compare_scene(Comparison& comparison, const std::string& name) {
    Scene scene;
    const auto load = [&] { scene = load_given_scene(name, comparison.arguments.how, comparison.arguments.console); };
    if (!comparison.unread.read(name, load)) {
        comparison.warnings.insert(comparison.unread.errors().back());
        return;
    }
    comparison.warnings.insert(scene.warnings.begin(), scene.warnings.end());
    comparison.renderer.set_scene(scene);
    if (comparison.json["runs"].empty()) print_comparison_head(comparison.arguments.console);
    // An older report in the folder is replaced when there is something to replace it with.
    if (comparison.arguments.html && !comparison.report) comparison.report.emplace(*comparison.arguments.html);
    for (int index = 0; index < comparison.arguments.views; ++index) {
        ComparedView view = exact_view(comparison, name, scene, index);
        std::vector<Drawn> all;
        for (const NamedTechnique& technique : comparison.techniques) all.push_back(draw(comparison, view, technique));
        reduce_noise(comparison, view, all);
        if (comparison.report)
            comparison.report->add_picture({name, index, ""}, PictureKind::kImage, view.truth.result.display);
        for (const Drawn& drawn : all) {
            nlohmann::ordered_json run = describe(comparison, view, drawn);
            print_row(comparison.arguments.console, run);
            if (comparison.report) comparison.report->add_run(run);
            comparison.json["runs"].push_back(std::move(run));
        }
    }
    comparison.json["warnings"] = all_warnings(comparison);
    if (comparison.noise.samples > 0) comparison.json["truth_samples"] = comparison.noise.samples;
    comparison.json["image_truth"] = describe_truth(comparison.arguments, comparison.noise.samples);
    save(comparison);  // after every scene, so that a bad one later loses nothing
}

void check_arguments(const CompareArguments& arguments) {
    if (arguments.views < 1 || arguments.views > 360)
        throw Error(fmt::format("--views must be 1 to 360, not {}", arguments.views));
    if (!find_technique(arguments.truth).reference) {
        throw Error(fmt::format("--truth: {} is no reference technique", arguments.truth));
    }
    std::set<std::string> seen;
    for (const std::string& scene : arguments.scenes) {
        if (!seen.insert(scene).second) throw Error(fmt::format("{} is given twice", scene));
    }
    if (!arguments.json) return;
    std::vector<std::string> inputs = arguments.scenes;
    inputs.push_back(arguments.environment.name_or_file);
    check_outputs({*arguments.json}, inputs);
    if (arguments.html && is_in_folder(*arguments.json, *arguments.html))
        throw Error(fmt::format("{}: lies in the folder of --html, which is the report's own", *arguments.json));
}

RenderSettings settings_of(const CompareArguments& arguments) {
    RenderSettings settings;
    std::tie(settings.width, settings.height) = parse_size(arguments.size);
    settings.samples = arguments.samples;
    settings.tonemap = parse_tonemap(arguments.tonemap);
    settings.exposure_ev = float(arguments.exposure_ev);
    settings.light = light_options(arguments.light);
    // Exact paths are shaded in the light of the environment.
    if (!find_technique(arguments.truth).all_light) settings.light.transport = LightTransport::kEnvironment;
    return settings;
}

/// Says before any work what could not be drawn.
void check_settings(const Comparison& comparison) {
    std::vector<NamedTechnique> with_truth = comparison.techniques;
    with_truth.push_back(comparison.truth);
    check_parameters(with_truth, comparison.parameters);
    comparison.renderer.check(settings_of_truth(comparison, comparison.truth));
    for (const NamedTechnique& technique : comparison.techniques)
        comparison.renderer.check(settings_for(comparison, technique));
}

void compare(const CompareArguments& arguments) {
    check_arguments(arguments);
    std::string environment_warning;
    const Environment environment = load_given_environment(arguments.environment, environment_warning);
    Comparison comparison{.arguments = arguments,
                          .renderer = Renderer(device_options(arguments.device)),
                          .techniques = {},
                          .parameters = given_parameters(arguments.parameters),
                          .settings = settings_of(arguments),
                          .truth = truth_named(arguments.truth),
                          .report = {},
                          .json = {},
                          .warnings = {},
                          .unread = UnreadScenes(arguments.scenes.size())};
    if (!environment_warning.empty()) comparison.warnings.insert(environment_warning);
    comparison.techniques = parse_techniques(arguments.techniques, comparison.renderer);
    check_settings(comparison);
    comparison.renderer.set_environment(environment);
    const DeviceInfo& device = comparison.renderer.device();
    comparison.json = {
        {"device", device.name},
        {"driver", device.driver},
        {"version", version()},
        {"environment", arguments.environment.name_or_file},
        {"environment_rotation_deg", arguments.environment.rotation_deg},
        {"environment_intensity", arguments.environment.intensity},
        {"exact_events", arguments.exact_events},
        {"truth", arguments.truth},
        {"truth_samples", truth_samples(arguments)},
        {"image_truth", describe_truth(arguments, 0)},
        {"image_truth_parameters",
         describe_parameters(comparison.truth.info(), settings_of_truth(comparison, comparison.truth).parameters)},
        {"warnings", nlohmann::ordered_json::array()},
        {"runs", nlohmann::ordered_json::array()}};

    for (const std::string& scene : arguments.scenes) compare_scene(comparison, scene);
    if (comparison.report) {
        const std::filesystem::path page =
            comparison.report->finish({.device = device.name,
                                       .driver = device.driver,
                                       .version = std::string(version()),
                                       .command = arguments.command_line,
                                       .reference = describe_truth(arguments, comparison.noise.samples)});
        arguments.console.print("Report: {}\n", page.string());
    }
    std::set<std::string> warnings = all_warnings(comparison);
    comparison.json["warnings"] = warnings;
    save(comparison);
    for (const std::string& error : comparison.unread.errors()) warnings.erase(error);  // printed before
    arguments.console.warn({warnings.begin(), warnings.end()});
    check_validation(comparison.renderer);
    comparison.unread.finish();
}

}  // namespace

void add_compare_command(CLI::App& app, const std::string& command_line) {
    auto arguments = std::make_shared<CompareArguments>();
    CompareArguments& a = *arguments;
    a.command_line = command_line;
    CLI::App* command =
        app.add_subcommand("compare", "Hold techniques against exact ray tracing, pixel by pixel, around scenes");
    add_compare_options(*command, a);
    command->callback([arguments] {
        const CompareArguments& given = *arguments;
        if (!given.thickness && given.pictures) throw Error("--pictures: goes with --thickness; otherwise give --html");
        if (!given.thickness) return compare(given);
        if (given.html) throw Error("--html: has no thickness; give --pictures");
        compare_thickness({given.scenes, given.size, given.thickness_how, given.pictures, given.json, given.how,
                           given.device, given.console});
    });
}

}  // namespace pellucid::cli
