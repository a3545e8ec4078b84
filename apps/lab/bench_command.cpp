#include "lab/accuracy.h"
#include "lab/bench_suites.h"
#include "lab/bench_timing.h"
#include "lab/commands.h"
#include "options/help.h"
#include "options/options.h"
#include "options/progress_bar.h"
#include "options/unread_scenes.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>

namespace pellucid::cli {
namespace {

struct BenchArguments {
    std::vector<std::string> scenes;
    std::optional<std::string> suite;
    std::optional<std::string> models;
    std::string techniques;  ///< empty: all that the device offers
    std::string size = "512x512";
    int frames = 30;
    EnvironmentArguments environment;
    bool deforming = false;
    std::optional<std::string> json;
    std::string command;  ///< the command line without folders, which differ from machine to machine
    SceneArguments how;
    DeviceArguments device;
    Console console;
    ParameterArguments parameters;
};

/// What stays the same from case to case, and where the results go.
struct Bench {
    const BenchArguments& arguments;
    Renderer renderer;
    std::vector<NamedTechnique> techniques;
    ParameterMap parameters;
    std::vector<BenchCase> cases;
    nlohmann::ordered_json json;
    std::set<std::string> warnings;
    UnreadScenes unread;
};

/// One view of one scene, with what ray tracing makes of it.
struct BenchView {
    const BenchCase& bench_case;
    std::unique_ptr<const Scene> scene;  ///< stays where it is: the tracer refers to it
    Camera camera;
    RenderSettings settings;  ///< without the technique
    ExactView exact;
    TimedTracer embree;
    std::uint32_t packet = 1;
    nlohmann::ordered_json described;  ///< what the runs of this view have in common

    TimedTrace trace() const {
        return {embree.tracer, camera, {.width = settings.width, .height = settings.height, .packet = packet}};
    }
};

nlohmann::ordered_json as_json(const std::vector<double>& times_ms) {
    const Spread s = spread(times_ms);
    return {{"median", s.median}, {"p95", s.p95}};
}

/// Share of covered pixels on which what is timed agrees with the exact paths to 1 degree.
double trace_within_1deg(const BenchView& view) {
    const TimedTrace trace = view.trace();
    std::vector<glm::vec3> directions(view.exact.paths.size());
    trace.tracer.trace_fast(trace.camera, trace.settings, directions);
    std::vector<RefractedPath> paths = view.exact.paths;
    for (std::size_t i = 0; i < paths.size(); ++i) paths[i].direction = directions[i];
    return judge(view.exact, paths).accuracy.within_1deg;
}

void add_deforming(BenchView& view, std::uint32_t threads) {
    const DeformingTimes times = time_deforming(*view.scene, view.camera, view.trace().settings, threads);
    view.described["embree_refit_ms"] = times.refit_ms;
    view.described["embree_rebuild_ms"] = {{"low", times.rebuild_low_ms}, {"medium", times.rebuild_medium_ms}};
    view.described["embree_deforming_ms"] = times.best_ms;
}

BenchView prepare_view(Bench& bench, const BenchCase& bench_case, std::unique_ptr<const Scene> scene) {
    const BenchArguments& arguments = bench.arguments;
    bench.warnings.insert(scene->warnings.begin(), scene->warnings.end());
    bench.renderer.set_scene(*scene);

    RenderSettings settings;
    std::tie(settings.width, settings.height) = bench_case.size ? *bench_case.size : parse_size(arguments.size);
    const Camera camera = bench_camera(bench_case, *scene, settings.width, settings.height);
    bench.renderer.set_camera(camera);

    ProgressBar bar(arguments.console, fmt::format("{}, exact", bench_case.scene));
    ExactView exact = trace_exact_view(bench.renderer.tracer(), camera, settings.width, settings.height,
                                       ExactSettings{}.max_events, bar.progress());
    TimedTracer embree = build_timed(*scene, arguments.device.threads);
    BenchView view{.bench_case = bench_case,
                   .scene = std::move(scene),
                   .camera = camera,
                   .settings = settings,
                   .exact = std::move(exact),
                   .embree = std::move(embree),
                   .described = {}};
    view.packet = fastest_packet(view.trace());
    view.described["objects"] = view.scene->objects.size();
    view.described["triangles"] = view.scene->triangle_count();
    view.described["embree_within_1deg"] = trace_within_1deg(view);
    view.described["embree_build_ms"] = view.embree.build_ms;
    if (arguments.deforming) add_deforming(view, arguments.device.threads);
    return view;
}

/// How many layers the deepest pixel has.
int most_layers(const RenderResult& result) {
    const std::vector<float>& counts = result.aovs.at("layers").pixels;
    return int(*std::max_element(counts.begin(), counts.end()));
}

nlohmann::ordered_json run_technique(Bench& bench, const BenchView& view, const NamedTechnique& technique) {
    RenderSettings settings = view.settings;
    settings.technique = technique.name;
    settings.parameters = parameters_of(technique, bench.parameters);
    if (view.bench_case.layers) settings.parameters["layers"] = *view.bench_case.layers;

    // The warm-up: shaders are compiled, memory is there. Its paths are those that the timed frames trace.
    RenderSettings first = settings;
    first.paths = true;
    first.aovs = {"layers"};
    const RenderResult result = bench.renderer.render(first);
    bench.warnings.insert(result.warnings.begin(), result.warnings.end());
    const PathAccuracy accuracy = judge(view.exact, result.paths).accuracy;

    ProgressBar bar(bench.arguments.console, fmt::format("{}, {}", view.bench_case.scene, technique.name));
    const AlternatingTimes times =
        time_alternately(bench.renderer, settings, bench.arguments.frames, view.trace(), bar.progress());

    nlohmann::ordered_json run{{"scene", view.bench_case.scene}};
    add_technique(run, technique);
    if (!view.bench_case.varied.empty()) run["varied"] = view.bench_case.varied;
    if (view.bench_case.distance) run["distance"] = *view.bench_case.distance;
    run["width"] = settings.width;
    run["height"] = settings.height;
    add_parameters(run, technique.info(), settings.parameters);
    run["covered"] = accuracy.covered;
    run["layers"] = most_layers(result);
    run["stable_share"] = accuracy.stable_share;
    run["within_1deg"] = accuracy.within_1deg;
    run["within_1deg_stable"] = accuracy.within_1deg_stable;
    run["frames"] = times.frames_ms.size();
    run["frame_ms"] = as_json(times.frames_ms);
    for (const auto& [name, times_ms] : times.passes_ms) run["passes"][name] = as_json(times_ms);
    const double frame_ms = spread(times.frames_ms).median, embree_ms = spread(times.traces_ms).median;
    run["embree_ms"] = embree_ms;
    run["embree_packet"] = view.packet;
    run["ratio_embree"] = embree_ms / frame_ms;
    run.update(view.described);
    // Not of a technique that keeps a hierarchy from frame to frame (`rebuild` 0).
    const auto rebuild = run["parameters"].find("rebuild");
    const bool keeps = rebuild != run["parameters"].end() && *rebuild == 0.0;
    if (view.described.contains("embree_deforming_ms") && !keeps)
        run["ratio_embree_deforming"] = view.described["embree_deforming_ms"].get<double>() / frame_ms;
    return run;
}

void print_bench_head(const Console& console) {
    console.print("{:<46} {:>9} {:>9} {:<20} {:>8} {:>9} {:>9} {:>9} {:>6}\n", "scene", "size", "triangles",
                  "technique", "stable%", "frame ms", "p95", "Embree ms", "ratio");
}

void print_run(const Console& console, const nlohmann::ordered_json& run) {
    std::string scene = run["scene"];
    if (run.contains("distance")) scene += fmt::format(" at {}", run["distance"].get<double>());
    console.print("{:<46} {:>9} {:>9} {:<20} {:>8.2f} {:>9.2f} {:>9.2f} {:>9.2f} {:>6.2f}\n", scene,
                  fmt::format("{}x{}", run["width"].get<int>(), run["height"].get<int>()),
                  run["triangles"].get<std::uint64_t>(), run["technique"].get<std::string>(),
                  100.0 * run["within_1deg_stable"].get<double>(), run["frame_ms"]["median"].get<double>(),
                  run["frame_ms"]["p95"].get<double>(), run["embree_ms"].get<double>(),
                  run["ratio_embree"].get<double>());
}

void save(const Bench& bench) {
    if (!bench.arguments.json) return;
    write_json(*bench.arguments.json, bench.json);
}

void run_case(Bench& bench, const BenchCase& bench_case) {
    std::vector<NamedTechnique> techniques = bench.techniques;
    if (bench_case.layers) {
        std::erase_if(techniques, [](const NamedTechnique& t) { return !has_parameter(t.info(), "layers"); });
    }
    if (techniques.empty()) return;
    std::unique_ptr<const Scene> scene;
    const auto load = [&] {
        scene = std::make_unique<const Scene>(with_copies(
            load_given_scene(bench_case.source, bench.arguments.how, bench.arguments.console), bench_case.copies));
    };
    if (!bench.unread.read(bench_case.scene, load)) {
        bench.warnings.insert(bench.unread.errors().back());
        return;
    }
    const BenchView view = prepare_view(bench, bench_case, std::move(scene));
    for (const NamedTechnique& technique : techniques) {
        nlohmann::ordered_json run = run_technique(bench, view, technique);
        print_run(bench.arguments.console, run);
        bench.json["runs"].push_back(std::move(run));
    }
    bench.json["warnings"] = bench.warnings;
    save(bench);  // after every case, so that a bad one later loses nothing
}

std::vector<BenchCase> cases_of(const BenchArguments& arguments, std::vector<std::string>& warnings) {
    if (arguments.scenes.empty() && !arguments.suite) throw Error("bench: give scenes, or a suite with --suite NAME");
    std::vector<BenchCase> cases;
    for (const std::string& scene : arguments.scenes) cases.push_back({.scene = scene, .source = scene});
    if (arguments.suite) {
        ModelFolder models(arguments.models.value_or(""), warnings);
        for (BenchCase& each : suite_cases(*arguments.suite, models)) cases.push_back(std::move(each));
    }
    return cases;
}

void check_arguments(const BenchArguments& arguments) {
    parse_size(arguments.size);
    if (arguments.frames < 1) throw Error(fmt::format("--frames must be at least 1, not {}", arguments.frames));
    if (arguments.models && !std::filesystem::is_directory(*arguments.models))
        throw Error(fmt::format("--models: {}: no such folder", *arguments.models));
}

void check_json(const BenchArguments& arguments, const std::vector<BenchCase>& cases) {
    if (!arguments.json) return;
    std::vector<std::string> inputs{arguments.environment.name_or_file};
    for (const BenchCase& each : cases) inputs.push_back(each.source);
    check_outputs({*arguments.json}, inputs);
}

/// Draws nothing once with every technique: what the renderer refuses it refuses before long work.
void check_drawing(Bench& bench) {
    RenderSettings settings;
    std::tie(settings.width, settings.height) = parse_size(bench.arguments.size);
    for (const NamedTechnique& technique : bench.techniques) {
        settings.technique = technique.name;
        settings.parameters = parameters_of(technique, bench.parameters);
        bench.renderer.render(settings);
    }
}

std::vector<NamedTechnique> timed_techniques(const std::string& names, const Renderer& renderer) {
    std::vector<NamedTechnique> chosen = parse_techniques(names, renderer);
    for (const NamedTechnique& technique : chosen) {
        if (technique.info().reference)
            throw Error(
                fmt::format("--techniques: {} traces on the CPU: every run is timed against it", technique.name));
    }
    return chosen;
}

void run_bench(const BenchArguments& arguments) {
    check_arguments(arguments);
    std::vector<std::string> missing;
    std::vector<BenchCase> cases = cases_of(arguments, missing);
    check_json(arguments, cases);
    std::string environment_warning;
    const Environment environment = load_given_environment(arguments.environment, environment_warning);
    UnreadScenes unread(cases.size());
    Bench bench{.arguments = arguments,
                .renderer = Renderer(device_options(arguments.device)),
                .techniques = {},
                .parameters = given_parameters(arguments.parameters),
                .cases = std::move(cases),
                .json = {},
                .warnings = {missing.begin(), missing.end()},
                .unread = std::move(unread)};
    if (!environment_warning.empty()) bench.warnings.insert(environment_warning);
    bench.techniques = timed_techniques(arguments.techniques, bench.renderer);
    check_parameters(bench.techniques, bench.parameters);
    check_drawing(bench);
    bench.renderer.set_environment(environment);
    const DeviceInfo& device = bench.renderer.device();
    bench.json = {{"device", device.name},
                  {"driver", device.driver},
                  {"version", version()},
                  {"cpu", cpu_name()},
                  {"cpu_threads", bench.renderer.tracer().threads()},
                  {"command", arguments.command},
                  {"suite", arguments.suite.value_or("")},
                  {"environment", arguments.environment.name_or_file},
                  {"environment_rotation_deg", arguments.environment.rotation_deg},
                  {"environment_intensity", arguments.environment.intensity},
                  {"warnings", bench.warnings},
                  {"runs", nlohmann::ordered_json::array()}};
    print_bench_head(arguments.console);
    for (const BenchCase& each : bench.cases) run_case(bench, each);
    bench.json["warnings"] = bench.warnings;
    save(bench);
    for (const std::string& error : bench.unread.errors()) bench.warnings.erase(error);  // printed before
    arguments.console.warn({bench.warnings.begin(), bench.warnings.end()});
    check_validation(bench.renderer);
    bench.unread.finish();
}

}  // namespace

void add_bench_command(CLI::App& app) {
    auto arguments = std::make_shared<BenchArguments>();
    BenchArguments& a = *arguments;
    CLI::App* command = app.add_subcommand(
        "bench", "Time techniques pass by pass, in turn with exact ray tracing of the same view on the CPU");
    command->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    command->add_option("scenes", a.scenes, kSceneHelp)
        ->type_name("SCENE...")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command->option_defaults()->group("Measurement");
    command->add_option("--suite", a.suite, "Scenes, cameras and sizes by name (help suites)")->type_name("NAME");
    command->add_option("--models", a.models, "Folder with the model files that a suite asks for")->type_name("DIR");
    add_techniques_option(*command, a.techniques);
    command->add_option("--size", a.size, "Width and height in pixels, where the suite does not say")
        ->capture_default_str()
        ->type_name("WxH");
    add_number(*command, "--frames", a.frames, "Frames that are timed, after a warm-up")->capture_default_str();
    command->add_flag("--deforming", a.deforming,
                      "Time as well what ray tracing pays where every vertex moves from frame to frame");
    command->add_option("--json", a.json, "Write every measure of every run")->type_name("FILE");
    add_environment_options(*command, a.environment);
    add_scene_options(*command, a.how);
    add_device_options(*command, a.device);
    add_console_options(*command, a.console);
    add_parameter_options(*command, a.parameters);
    set_examples(*command, {"pellucid bench --suite quick --json times.json",
                            "pellucid bench bunny.obj --techniques fast,balanced --size 1024x1024"});
    command->callback([arguments, command] {
        arguments->command = "pellucid bench" + arguments_without_folders(*command);
        run_bench(*arguments);
    });
}

}  // namespace pellucid::cli
