#include "viewer/options.h"

#include "options/arguments.h"
#include "options/help.h"

#include <pellucid/pellucid.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace pellucid::viewer {

void add_options(CLI::App& app, Options& o) {
    o.app = &app;
    app.set_version_flag("--version", std::string(version()));
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    app.add_option("scene", o.scene, cli::kSceneHelp + std::string("; default: what was open last"))
        ->type_name("SCENE");
    app.option_defaults()->group("Window");
    app.add_option("--size", o.size, "Of the window, pixels (default: as last, or 960x540)")->type_name("WxH");
    app.add_option("--screenshot", o.screenshot, "Write what the window shows once the image is finished, and exit")
        ->type_name("FILE.png");
    app.add_option("--script", o.script, "Run the commands of a file (docs/viewer.md), and exit")->type_name("FILE");
    app.add_flag("--no-panels", o.no_panels, "Begin without panels; Tab shows them");
    app.add_flag("--fresh", o.fresh, "Neither read nor keep what was open last");
    app.option_defaults()->group("Image");
    app.add_option("--technique", o.technique, "A preset or a technique (help presets, pellucid techniques)")
        ->capture_default_str()
        ->type_name("NAME");
    cli::add_camera_options(app, o.camera, o.fov_deg);
    cli::add_number(app, "--samples", o.samples, "Of the finished image")
        ->capture_default_str()
        ->check(CLI::Range(1, 65536))
        ->type_name("N");
    cli::add_display_options(app, o.tonemap, o.exposure_ev);
    cli::add_environment_options(app, o.environment);
    cli::add_scene_options(app, o.how);
    cli::add_device_options(app, o.device);
    cli::add_parameter_options(app, o.parameters);
    const auto print_json = [&app] {
        fmt::print("{}\n", cli::describe_options(app).dump(2));
        throw CLI::Success();
    };
    app.add_flag_callback("--help-json", print_json, "Print the table that man pages and completion are made of")
        ->group("");
    cli::set_examples(app, {"pellucid-view model.glb --environment studio.hdr",
                            "pellucid-view shape:goblet --screenshot goblet.png --samples 64"});
}

void Options::check() const {
    check_technique_name(technique);
    if (parse_tonemap(tonemap) == ToneMap::kKrawczyk)
        throw Error("--tonemap: krawczyk is for still images, of pellucid render");
    cli::given_parameters(parameters);
}

void Options::apply(Document& document) const {
    Look& look = document.look;
    const auto given = [&](const char* name) { return app->count(name) > 0; };
    if (given("--technique")) look.technique = technique;
    for (const auto& [name, value] : cli::given_parameters(parameters)) look.parameters[name] = value;
    if (given("--samples")) look.samples = samples;
    if (given("--tonemap")) look.tonemap = parse_tonemap(tonemap);
    if (given("--exposure")) look.exposure_ev = float(exposure_ev);
    if (given("--environment-rotation")) look.environment_rotation_deg = environment.rotation_deg;
    if (given("--environment-intensity")) look.environment_intensity = environment.intensity;
    if (fov_deg) look.camera.fov_deg = float(*fov_deg);
    if (!camera) return;
    const float fov = glm::radians(look.camera.fov_deg);
    const Camera chosen = cli::parse_camera(*camera, document.scene(), fov);
    look.file_camera = camera->starts_with("orbit:") ? "" : chosen.name;
    if (!look.file_camera.empty()) return;
    const std::vector<double> numbers = cli::parse_numbers(
        "--camera", camera->substr(6), std::size_t(std::count(camera->begin(), camera->end(), ',')) + 1);
    look.camera = {.target = document.bounds().center,
                   .azimuth_deg = float(numbers[0]),
                   .elevation_deg = float(numbers[1]),
                   .distance = float(numbers[2]),
                   .fov_deg = look.camera.fov_deg};
    if (numbers.size() == 6)
        look.camera.target = glm::dvec3(numbers[3], numbers[4], numbers[5]) - document.scene().origin;
}

}  // namespace pellucid::viewer
