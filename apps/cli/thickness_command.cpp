#include "commands.h"
#include "options/help.h"
#include "options/options.h"
#include "options/progress_bar.h"
#include "options/translucency_options.h"

#include <pellucid/file.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <optional>

namespace pellucid::cli {
namespace {

constexpr const char* kExact = "exact";

struct ThicknessCommandArguments {
    std::string scene;
    std::string output;
    ThicknessArguments thickness;
    std::string size = "512x512";
    std::optional<std::string> camera;
    std::uint32_t light = 0;
    std::optional<std::string> picture;
    std::optional<std::string> json;
    SceneArguments how;
    DeviceArguments device;
    Console console;
};

nlohmann::ordered_json statistics(const Image& thickness) {
    std::uint64_t points = 0, lit = 0, shadowed = 0;
    double sum = 0.0, largest = 0.0;
    for (const float d : thickness.pixels) {
        shadowed += d == kShadowed ? 1 : 0;
        if (d < 0.0f) continue;
        ++points;
        lit += d == 0.0f ? 1 : 0;
        sum += double(d);
        largest = std::max(largest, double(d));
    }
    const std::uint64_t through = points - lit;
    return {{"points", points},
            {"lit", lit},
            {"shadowed", shadowed},
            {"mean_m", through > 0 ? sum / double(through) : 0.0},
            {"largest_m", largest}};
}

nlohmann::ordered_json describe(const ThicknessCommandArguments& arguments, const Image& thickness) {
    nlohmann::ordered_json json{
        {"version", version()},     {"scene", arguments.scene}, {"method", arguments.thickness.method},
        {"light", arguments.light}, {"width", thickness.width}, {"height", thickness.height}};
    json.update(statistics(thickness));
    return json;
}

void check_arguments(const ThicknessCommandArguments& arguments) {
    if (lower_extension(arguments.output) != ".exr")
        throw Error(fmt::format("--output: '{}': thickness is written as .exr", arguments.output));
    std::vector<std::string> outputs{arguments.output};
    if (arguments.picture) {
        if (lower_extension(*arguments.picture) != ".png")
            throw Error(fmt::format("--picture: '{}': pictures are written as .png", *arguments.picture));
        outputs.push_back(*arguments.picture);
    }
    if (arguments.json) outputs.push_back(*arguments.json);
    check_outputs(outputs, {arguments.scene});
    if (arguments.thickness.method != kExact) parse_thickness_method(arguments.thickness.method);
}

void measure(const ThicknessCommandArguments& arguments) {
    check_arguments(arguments);
    const auto [width, height] = parse_size(arguments.size);
    const Scene scene = load_given_scene(arguments.scene, arguments.how, arguments.console);
    if (scene.lights.empty())
        throw Error(fmt::format("{}: there is no light; give one with --add-light", arguments.scene));
    if (arguments.light >= scene.lights.size())
        throw Error(
            fmt::format("--light: there is no light {}; the scene has {}", arguments.light, scene.lights.size()));
    Camera camera = framing_camera(scene_bounds(scene), width, height, Camera{}.vertical_fov);
    if (arguments.camera)
        camera = parse_camera(*arguments.camera, scene, Camera{}.vertical_fov);
    else if (!scene.cameras.empty())
        camera = scene.cameras.front();

    std::vector<std::string> warnings = scene.warnings;
    nlohmann::ordered_json json;
    Image thickness;
    ProgressBar bar(arguments.console, arguments.thickness.method);
    if (arguments.thickness.method == kExact) {
        thickness = ThicknessTracer(scene, arguments.device.threads)
                        .trace(camera, width, height, arguments.light, bar.progress());
        json = describe(arguments, thickness);
    } else {
        Renderer renderer(device_options(arguments.device));
        renderer.set_scene(scene);
        renderer.set_camera(camera);
        ThicknessResult result = renderer.measure_thickness({.width = width,
                                                             .height = height,
                                                             .settings = thickness_settings(arguments.thickness),
                                                             .light = arguments.light,
                                                             .progress = bar.progress()});
        thickness = std::move(result.thickness);
        warnings.insert(warnings.end(), result.warnings.begin(), result.warnings.end());
        if (result.cut_rays > 0)
            warnings.push_back(
                fmt::format("light meets more than {} surfaces on its way to {} pixels: give more --layers",
                            arguments.thickness.layers, result.cut_rays));
        json = describe(arguments, thickness);
        json.update({{"layers", arguments.thickness.layers},
                     {"light_map", arguments.thickness.resolution},
                     {"light_views", result.light_views},
                     {"cut_rays", result.cut_rays},
                     {"geometry_passes", result.geometry_passes},
                     {"wall_ms", result.wall_ms},
                     {"device", renderer.device().name},
                     {"driver", renderer.device().driver}});
        check_validation(renderer);
    }
    bar.clear();
    if (json["points"] == 0 && json["shadowed"] == 0)
        warnings.push_back(
            "no translucent surface is seen that the light reaches; --translucent makes one of any mesh");
    json["warnings"] = warnings;
    write_image(arguments.output, thickness, {"thickness"});
    if (arguments.picture) write_image(*arguments.picture, color_thickness(thickness, largest_value(thickness)));
    if (arguments.json) write_json(*arguments.json, json);
    arguments.console.print(
        "{} points, {} of them lit, {} in shadow; through the others: mean {:.6g} m, largest {:.6g} m\n",
        json["points"].get<std::uint64_t>(), json["lit"].get<std::uint64_t>(), json["shadowed"].get<std::uint64_t>(),
        json["mean_m"].get<double>(), json["largest_m"].get<double>());
    arguments.console.warn(warnings);
}

}  // namespace

void add_thickness_command(CLI::App& app) {
    auto arguments = std::make_shared<ThicknessCommandArguments>();
    ThicknessCommandArguments& a = *arguments;
    CLI::App* command = app.add_subcommand(
        "thickness", "Measure how much solid lies between a light and every visible point of what is translucent");
    command->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    command->add_option("scene", a.scene, kSceneHelp)->required()->type_name("SCENE");
    command->option_defaults()->group("Output");
    command->add_option("-o,--output", a.output, ".exr, one channel: metres, or below 0 (help translucency)")
        ->required()
        ->type_name("FILE");
    command->add_option("--picture", a.picture, "Also a .png: thin is dark blue, thick is pale yellow")
        ->type_name("FILE");
    command->add_option("--json", a.json, "Write statistics, passes, time and warnings")->type_name("FILE");
    add_size_option(*command, a.size);
    command->add_option("--camera", a.camera, "A camera of the file, or orbit:AZ,EL,DIST[,X,Y,Z] (help cameras)")
        ->type_name("CAMERA");
    add_thickness_options(*command, a.thickness, true);
    command->get_option("--method")->description("Method, or exact: rays of Embree (help translucency)");
    add_number(*command, "--light-number,--light", a.light, "Of the file's lights from 0, then those of --add-light")
        ->capture_default_str();
    add_scene_options(*command, a.how);
    add_device_options(*command, a.device);
    add_console_options(*command, a.console);
    set_examples(*command, {"pellucid thickness shape:torus -o torus.exr --translucent 0.8,0.3,0.2,0.1 "
                            "--add-light sun:30,40"});
    command->callback([arguments] { measure(*arguments); });
}

}  // namespace pellucid::cli
