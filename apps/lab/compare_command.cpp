#include "lab/accuracy.h"
#include "lab/commands.h"
#include "lab/thickness_compare.h"
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

struct CompareArguments {
    std::vector<std::string> scenes;
    std::string techniques;  ///< empty: all that the device offers
    std::string size = "512x512";
    int views = 4;
    std::uint32_t samples = 4;
    std::uint32_t exact_events = ExactSettings{}.max_events;
    std::string truth = "reference";
    std::uint32_t truth_samples = 64;
    EnvironmentArguments environment;
    std::string tonemap = "neutral";
    double exposure_ev = 0.0;
    std::optional<std::string> json;
    std::optional<std::string> html;
    bool thickness = false;
    std::optional<std::string> pictures;
    ThicknessArguments thickness_how;
    LightArguments light;
    SceneArguments how;
    DeviceArguments device;
    ParameterArguments parameters;
    std::string command_line;
};

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
};

/// One camera around one scene.
struct ComparedView {
    std::string scene;
    int index;
    OrbitView orbit;
    std::uint64_t triangles;
    ExactView exact;
    std::string truth_name;
    RenderResult truth;  ///< the picture that the others are held against
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
    if (truth.info().all_light) settings.samples = comparison.arguments.truth_samples;
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

nlohmann::ordered_json compare_technique(Comparison& comparison, const ComparedView& view,
                                         const NamedTechnique& technique) {
    RenderSettings settings = settings_for(comparison, technique);
    settings.paths = true;
    const RenderResult result = comparison.renderer.render(settings);
    add_warnings(comparison, view.scene, technique.name, result);

    const Judgement judgement = judge(view.exact, result.paths);
    const Image flip = flip_ldr(view.truth.display, result.display);
    nlohmann::ordered_json run{{"scene", view.scene}};
    add_technique(run, technique);
    run["view"] = view.index;
    run["camera"] = view.orbit.description();
    run["width"] = settings.width;
    run["height"] = settings.height;
    run["triangles"] = view.triangles;
    run["parameters"] = describe_parameters(technique.info(), settings.parameters);
    if (view.truth_name != comparison.truth.name) run["image_truth"] = view.truth_name;
    add_accuracy(run, view.exact, judgement.accuracy);
    if (judgement.accuracy.covered > 0) {
        run["flip_mean"] = mean(flip, view.exact.covered);
        run["rmse"] = rmse(view.truth.radiance, result.radiance, view.exact.covered);
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

    ProgressBar bar(fmt::format("{}, view {} of {}, exact", name, index + 1, arguments.views));
    ComparedView view{name,
                      index,
                      orbit,
                      scene.triangle_count(),
                      trace_exact_view(comparison.renderer.tracer(), camera, settings.width, settings.height,
                                       arguments.exact_events, bar.progress()),
                      {},
                      {}};
    settings = settings_of_truth(comparison, truth_for(comparison, name, scene));
    view.truth_name = settings.technique;
    settings.progress = bar.progress();
    view.truth = comparison.renderer.render(settings);
    add_warnings(comparison, name, settings.technique, view.truth);
    if (comparison.report) comparison.report->add_picture({name, index, ""}, PictureKind::kImage, view.truth.display);
    return view;
}

void save(const Comparison& comparison) {
    if (!comparison.arguments.json) return;
    write_json(*comparison.arguments.json, comparison.json);
}

void print_head() {
    fmt::print("{:<28} {:>4} {:<22} {:>7} {:>7} {:>8} {:>7} {:>8}\n", "scene", "view", "technique", "1 deg%", "5 deg%",
               "stable%", "median", "FLIP");
}

void print_row(const nlohmann::ordered_json& run) {
    const auto cell = [&](const char* key, double scale, int width, int digits) {
        const auto& value = run[key];
        return value.is_null() ? fmt::format("{:>{}}", "-", width)
                               : fmt::format("{:>{}.{}f}", scale * value.get<double>(), width, digits);
    };
    fmt::print("{:<28} {:>4} {:<22} {} {} {} {} {}\n", run["scene"].get<std::string>(), run["view"].get<int>(),
               run["technique"].get<std::string>(), cell("within_1deg", 100.0, 7, 2), cell("within_5deg", 100.0, 7, 2),
               cell("within_1deg_stable", 100.0, 8, 2), cell("median_deg", 1.0, 7, 2), cell("flip_mean", 1.0, 8, 4));
    std::fflush(stdout);
}

void compare_scene(Comparison& comparison, const std::string& name) {
    Scene scene;
    if (!comparison.unread.read(name, [&] { scene = load_given_scene(name, comparison.arguments.how); })) {
        comparison.warnings.insert(comparison.unread.errors().back());
        return;
    }
    comparison.warnings.insert(scene.warnings.begin(), scene.warnings.end());
    comparison.renderer.set_scene(scene);
    if (comparison.json["runs"].empty()) print_head();
    // An older report in the folder is replaced when there is something to replace it with.
    if (comparison.arguments.html && !comparison.report) comparison.report.emplace(*comparison.arguments.html);
    for (int index = 0; index < comparison.arguments.views; ++index) {
        const ComparedView view = exact_view(comparison, name, scene, index);
        for (const NamedTechnique& technique : comparison.techniques) {
            nlohmann::ordered_json run = compare_technique(comparison, view, technique);
            print_row(run);
            if (comparison.report) comparison.report->add_run(run);
            comparison.json["runs"].push_back(std::move(run));
        }
    }
    comparison.json["warnings"] = comparison.warnings;
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

std::string describe_truth(const CompareArguments& arguments) {
    const bool all_light = find_technique(arguments.truth).all_light;
    return fmt::format("{}, samples per pixel: {}", arguments.truth,
                       all_light ? arguments.truth_samples : arguments.samples);
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
        {"image_truth", describe_truth(arguments)},
        {"image_truth_parameters",
         describe_parameters(comparison.truth.info(), settings_of_truth(comparison, comparison.truth).parameters)},
        {"warnings", nlohmann::ordered_json::array()},
        {"runs", nlohmann::ordered_json::array()}};

    for (const std::string& scene : arguments.scenes) compare_scene(comparison, scene);
    if (comparison.report) {
        const std::filesystem::path page = comparison.report->finish({.device = device.name,
                                                                      .driver = device.driver,
                                                                      .version = std::string(version()),
                                                                      .command = arguments.command_line,
                                                                      .reference = describe_truth(arguments)});
        fmt::print("Report: {}\n", page.string());
    }
    comparison.json["warnings"] = comparison.warnings;
    save(comparison);
    for (const std::string& error : comparison.unread.errors()) comparison.warnings.erase(error);  // printed before
    print_warnings({comparison.warnings.begin(), comparison.warnings.end()});
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
    command->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    command->add_option("scenes", a.scenes, shape_help())
        ->required()
        ->type_name("SCENE...")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command
        ->add_option("--techniques", a.techniques,
                     "Names with commas; default: all that the device offers and that are no reference. There are:" +
                         preset_list() + technique_list())
        ->type_name("A,B,..");
    command->add_option("--size", a.size, "Width and height in pixels")->capture_default_str()->type_name("WxH");
    add_number(*command, "--views", a.views, "Cameras around the object, 15 degrees above it, the first from the front")
        ->capture_default_str();
    add_number(*command, "--samples", a.samples, "Jittered frames per picture; paths are compared at pixel centres")
        ->capture_default_str();
    add_number(*command, "--exact-events", a.exact_events, "Interface events that exact paths may have")
        ->capture_default_str()
        ->check(CLI::Range(1, 4095));
    command
        ->add_option("--truth", a.truth,
                     "Whose picture FLIP and RMSE are taken against: reference (the exact transmitted path, shaded as "
                     "the others are) or path (all light)")
        ->capture_default_str()
        ->type_name("NAME");
    add_number(*command, "--truth-samples", a.truth_samples, "Paths per pixel of --truth path")->capture_default_str();
    add_environment_options(*command, a.environment);
    command->add_option("--tonemap", a.tonemap, "none, reinhard, aces, neutral or krawczyk")
        ->capture_default_str()
        ->type_name("NAME");
    add_number(*command, "--exposure", a.exposure_ev, "Exposure in stops")->capture_default_str()->type_name("EV");
    command->add_option("--json", a.json, "Write every measure of every run")->type_name("FILE");
    command->add_option("--html", a.html, "Write a report that opens in a browser from disk")->type_name("DIR");
    add_scene_options(*command, a.how);
    add_device_options(*command, a.device);
    add_parameter_options(*command, a.parameters);
    command->add_flag("--thickness", a.thickness,
                      "Compare the ways to find the thickness of what is translucent instead, against rays of Embree, "
                      "for every light: from behind, from the side and from the top");
    add_light_options(*command, a.light);
    add_light_map_options(*command, a.thickness_how, "--thickness-layers");
    command->add_option("--pictures", a.pictures, "With --thickness: pictures of thickness and error, .png")
        ->type_name("DIR");
    command->callback([arguments] {
        const CompareArguments& given = *arguments;
        if (!given.thickness && given.pictures) throw Error("--pictures: goes with --thickness; otherwise give --html");
        if (!given.thickness) return compare(given);
        if (given.html) throw Error("--html: has no thickness; give --pictures");
        compare_thickness(
            {given.scenes, given.size, given.thickness_how, given.pictures, given.json, given.how, given.device});
    });
}

}  // namespace pellucid::cli
