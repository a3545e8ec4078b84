#include "lab/bench_timing.h"
#include "lab/commands.h"
#include "lab/experiment_run.h"
#include "options/help.h"
#include "options/options.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <memory>
#include <optional>
#include <set>

namespace pellucid::cli {
namespace {

struct ExperimentArguments {
    std::vector<std::string> names;
    bool list = false;
    std::optional<std::string> models;
    std::string report = "out/experiments";
    std::optional<std::string> json;
    std::optional<std::string> size;
    bool again = false;
    int frames = 30;
    DeviceArguments device;
    Console console;
    std::string options;  ///< the command's options, without folders
};

constexpr const char* kAll = "all";

void print_list() {
    for (const ExperimentSpec& spec : experiments())
        fmt::print("{:<18} {}; varied: {}\n", spec.name, spec.source, spec.varied);
}

/// In the order of the table, each once.
std::vector<const ExperimentSpec*> chosen_experiments(const std::vector<std::string>& names) {
    std::set<std::string> wanted;
    for (const std::string& name : names) {
        if (name != kAll) wanted.insert(find_experiment(name).name);
    }
    const bool all = std::find(names.begin(), names.end(), kAll) != names.end();
    std::vector<const ExperimentSpec*> chosen;
    for (const ExperimentSpec& spec : experiments()) {
        if (all || wanted.contains(spec.name)) chosen.push_back(&spec);
    }
    return chosen;
}

void check_arguments(const ExperimentArguments& arguments) {
    if (arguments.size) parse_size(*arguments.size);
    if (arguments.frames < 1) throw Error(fmt::format("--frames must be at least 1, not {}", arguments.frames));
    if (arguments.models && !std::filesystem::is_directory(*arguments.models))
        throw Error(fmt::format("--models: {}: no such folder", *arguments.models));
}

/// The JSON may not take the place of a model, nor of a page.
void check_json(const ExperimentArguments& arguments, const std::vector<const ExperimentSpec*>& chosen) {
    if (!arguments.json) return;
    std::vector<std::string> missing, sources;
    ModelFolder models(arguments.models.value_or(""), missing);
    for (const ExperimentSpec* spec : chosen) {
        if (spec->scenes == nullptr) continue;
        for (const ExperimentScene& scene : spec->scenes(models)) {
            if (!scene.how.source.empty()) sources.push_back(scene.how.source);
        }
    }
    check_outputs({*arguments.json}, sources);
    if (is_in_folder(*arguments.json, arguments.report))
        throw Error(
            fmt::format("--json: {} lies in the folder of --report, which pages are written to", *arguments.json));
}

/// What the results of an experiment depend on.
nlohmann::ordered_json conditions_of(const ExperimentSpec& spec, const ExperimentArguments& arguments,
                                     Renderer& renderer) {
    return {{"command", fmt::format("pellucid experiment {}{}", spec.name, arguments.options)},
            {"models", std::filesystem::absolute(arguments.models.value_or(".")).string()},
            {"device", renderer.device().name},
            {"version", version()},
            {"cpu", cpu_name()},
            {"cpu_threads", renderer.tracer().threads()}};
}

/// The results that an earlier run under the same conditions has left with its page; null: there are none.
nlohmann::ordered_json kept_results(const std::filesystem::path& file, const nlohmann::ordered_json& conditions) {
    std::ifstream in(file);
    const auto kept = nlohmann::ordered_json::parse(in, nullptr, false);
    const bool usable = kept.is_object() && kept.contains("conditions") && kept.contains("experiment");
    return usable && kept["conditions"] == conditions ? kept["experiment"] : nlohmann::ordered_json();
}

/// Runs one experiment and writes its page; what it measured, for the JSON.
nlohmann::ordered_json run_one(const ExperimentArguments& arguments, const ExperimentSpec& spec, Renderer& renderer,
                               UnreadScenes& unread) {
    const auto [width, height] = arguments.size ? parse_size(*arguments.size) : spec.size;
    ExperimentRun run{.renderer = renderer,
                      .width = width,
                      .height = height,
                      .frames = arguments.frames,
                      .threads = arguments.device.threads,
                      .unread = unread,
                      .console = arguments.console,
                      .warnings = {}};
    std::vector<std::string> missing;
    ModelFolder models(arguments.models.value_or(""), missing);
    const std::vector<ExperimentScene> scenes =
        spec.scenes != nullptr ? spec.scenes(models) : std::vector<ExperimentScene>();
    run.warnings.insert(missing.begin(), missing.end());
    const std::vector<Variant> variants = available_variants(spec, run);
    const std::string command = fmt::format("pellucid experiment {}{}", spec.name, arguments.options);
    std::vector<std::string> warnings;
    const std::filesystem::path folder = std::filesystem::path(arguments.report) / spec.name;
    if (spec.run == nullptr && (scenes.empty() || variants.empty())) {
        if (std::filesystem::is_directory(folder))
            ExperimentPage(folder, spec);  // an older page would pass for this one
        warnings.assign(run.warnings.begin(), run.warnings.end());
        warnings.push_back("nothing is left to measure");
    } else {
        ExperimentPage page(folder, spec);
        if (spec.run != nullptr)
            spec.run(run, spec, models, page);
        else
            run_experiment(run, spec, scenes, variants, page);
        run.warnings.insert(missing.begin(), missing.end());
        warnings.assign(run.warnings.begin(), run.warnings.end());
        const DeviceInfo& device = renderer.device();
        page.finish({.device = device.name,
                     .driver = device.driver,
                     .version = std::string(version()),
                     .cpu = fmt::format("{}, {} threads", cpu_name(), renderer.tracer().threads()),
                     .environment = spec.environment,
                     .size = fmt::format("{}x{}", width, height),
                     .command = command},
                    run.runs, warnings);
    }
    for (std::string& warning : warnings) warning = fmt::format("{}: {}", spec.name, warning);
    arguments.console.warn(warnings);
    return {{"name", spec.name},         {"source", spec.source},
            {"varied", spec.varied},     {"environment", spec.environment},
            {"truth", spec.truth.label}, {"command", command},
            {"warnings", warnings},      {"runs", run.runs}};
}

void run_experiments(const ExperimentArguments& arguments) {
    const std::vector<const ExperimentSpec*> chosen = chosen_experiments(arguments.names);
    if (arguments.list || arguments.names.empty()) return print_list();
    check_arguments(arguments);
    check_json(arguments, chosen);
    Renderer renderer(device_options(arguments.device));
    for (const ExperimentSpec* spec : chosen) {
        RenderSettings settings;
        settings.technique = spec->truth.technique;
        std::tie(settings.width, settings.height) = arguments.size ? parse_size(*arguments.size) : spec->size;
        renderer.check(settings);
    }
    write_experiment_index(arguments.report);  // before anything is measured: the folder may be another's
    const DeviceInfo& device = renderer.device();
    nlohmann::ordered_json json{{"device", device.name},
                                {"driver", device.driver},
                                {"version", version()},
                                {"cpu", cpu_name()},
                                {"cpu_threads", renderer.tracer().threads()},
                                {"experiments", nlohmann::ordered_json::array()}};
    UnreadScenes unread(0);
    const bool keeps = !arguments.again && chosen.size() > 1;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        const ExperimentSpec* spec = chosen[i];
        const std::filesystem::path results = experiment_results(arguments.report, *spec);
        const nlohmann::ordered_json conditions = conditions_of(*spec, arguments, renderer);
        nlohmann::ordered_json experiment = keeps ? kept_results(results, conditions) : nlohmann::ordered_json();
        const bool kept = !experiment.is_null();
        if (chosen.size() > 1)
            arguments.console.print("[{}/{}] {}{}\n", i + 1, chosen.size(), spec->name, kept ? ": results kept" : "");
        if (!kept) {
            const std::size_t errors = unread.errors().size();
            experiment = run_one(arguments, *spec, renderer, unread);
            // Last, so that an interrupted run is not kept.
            if (!experiment["runs"].empty() && unread.errors().size() == errors)
                write_json(results.string(), {{"conditions", conditions}, {"experiment", experiment}});
        }
        json["experiments"].push_back(std::move(experiment));
        // After every experiment, so that what fails later loses nothing.
        if (arguments.json) write_json(*arguments.json, json);
        const std::filesystem::path index = write_experiment_index(arguments.report);
        if (spec == chosen.back()) arguments.console.print("Report: {}\n", index.string());
    }
    check_validation(renderer);
    unread.finish();
}

}  // namespace

void add_experiment_command(CLI::App& app) {
    auto arguments = std::make_shared<ExperimentArguments>();
    ExperimentArguments& a = *arguments;
    CLI::App* command =
        app.add_subcommand("experiment", "Repeat experiments of the publications; each writes its table and figure");
    command->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    CLI::Option* names = command->add_option("names", a.names, "Experiments, or 'all'; none: list what there is")
                             ->type_name("NAME...")
                             ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command->option_defaults()->group("Experiment");
    command->add_flag("--list", a.list, "Print what there is, a line each");
    command->add_option("--models", a.models, "Folder with the model files that experiments ask for")->type_name("DIR");
    command
        ->add_option("--report,--html", a.report,
                     "Folder of the pages; a page is replaced when its experiment runs again")
        ->capture_default_str()
        ->type_name("DIR");
    command->add_option("--json", a.json, "Write every measure of every run")->type_name("FILE");
    command->add_option("--size", a.size, "Width and height in pixels; default: what each experiment is made for")
        ->type_name("WxH");
    command->add_flag("--again", a.again, "Of several: repeat those, too, that --report has results of");
    add_number(*command, "--frames", a.frames, "Frames that are timed, where times are taken")->capture_default_str();
    add_device_options(*command, a.device);
    add_console_options(*command, a.console);
    set_examples(*command, {"pellucid experiment wang-many-objects --report out/experiments",
                            "pellucid experiment all --models ../models"});
    command->callback([arguments, command, names] {
        arguments->options = arguments_without_folders(*command, names);  // a page names its own experiment
        run_experiments(*arguments);
    });
}

}  // namespace pellucid::cli
