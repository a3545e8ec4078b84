// pellucid thickness: the length of solid between a light and every visible point, as an image and in numbers.
#include "arguments.h"
#include "commands.h"
#include "options.h"
#include "progress_bar.h"
#include "translucency_options.h"

#include "core/file.h"
#include "core/file_extension.h"

#include <pellucid/pellucid.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

namespace pellucid::cli {
namespace {

struct ThicknessArguments {
    std::string scene, output;
    std::string size = "512x512";
    std::optional<std::string> camera, json;
    std::uint32_t light = 0;
    bool compare = false;
    TranslucencyArguments translucency;
    SceneArguments how;
    DeviceArguments device;
};

/// Of the pixels that have a thickness.
nlohmann::ordered_json statistics(const Image& thickness) {
    std::vector<double> values;
    std::size_t shadowed = 0;
    for (const float d : thickness.pixels) {
        if (d >= 0.0f)
            values.push_back(double(d));
        else if (d == kShadowed)
            ++shadowed;
    }
    nlohmann::ordered_json json{{"points", values.size()}, {"shadowed", shadowed}};
    if (values.empty()) return json;
    double sum = 0.0;
    std::size_t lit = 0;
    for (const double d : values) sum += d, lit += d == 0.0;
    std::sort(values.begin(), values.end());
    json["lit_side"] = lit;
    json["mean_m"] = sum / double(values.size());
    json["median_m"] = values[values.size() / 2];
    json["largest_m"] = values.back();
    return json;
}

void measure(const ThicknessArguments& a) {
    if (lower_extension(a.output) != ".exr")
        throw Error(fmt::format("--output: '{}': thickness is written as .exr", a.output));
    std::vector<std::string> outputs{a.output};
    if (a.json) outputs.push_back(*a.json);
    check_outputs(outputs, {a.scene});
    ThicknessRequest request;
    std::tie(request.width, request.height) = parse_size(a.size);
    request.settings = thickness_settings(a.translucency);
    request.light = a.light;
    LoadOptions options = load_options(a.how);
    options.translucent = parse_translucency(a.translucency);
    Scene scene = load_scene(a.scene, options);
    add_lights(scene, a.translucency);
    Renderer renderer(device_options(a.device));
    renderer.set_scene(scene);
    const Camera camera = a.camera                 ? parse_camera(*a.camera, scene, Camera{}.vertical_fov)
                          : !scene.cameras.empty() ? scene.cameras.front()
                                                   : framing_camera(scene_bounds(scene), request.width, request.height,
                                                                    Camera{}.vertical_fov);
    renderer.set_camera(camera);
    ProgressBar bar(a.translucency.method);
    request.progress = bar.progress();
    const ThicknessResult result = renderer.measure_thickness(request);
    std::vector<std::string> warnings = scene.warnings;
    warnings.insert(warnings.end(), result.warnings.begin(), result.warnings.end());
    nlohmann::ordered_json json{{"device", renderer.device().name},
                                {"version", version()},
                                {"scene", a.scene},
                                {"width", request.width},
                                {"height", request.height},
                                {"method", a.translucency.method},
                                {"layers", request.settings.layers},
                                {"light_map", request.settings.resolution},
                                {"light", request.light},
                                {"cut_rays", result.cut_rays},
                                {"geometry_passes", result.geometry_passes},
                                {"light_views", result.light_views},
                                {"wall_ms", result.wall_ms},
                                {"thickness", statistics(result.thickness)}};
    if (a.compare) {
        bar.set_label("exact");
        const Image exact = ThicknessTracer(scene, a.device.threads)
                                .trace(camera, request.width, request.height, request.light, bar.progress());
        const ThicknessError error = thickness_error(exact, result.thickness);
        json["error"] = {{"relative", error.relative}, {"mean_m", error.mean},   {"p95_m", error.p95},
                         {"largest_m", error.largest}, {"points", error.points}, {"unmatched", error.unmatched}};
    }
    bar.clear();
    write_image(a.output, result.thickness, {"thickness"});
    if (a.json) write_text_file(*a.json, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    const auto& found = json["thickness"];
    fmt::print("{} points", found["points"].get<std::size_t>());
    if (found.contains("mean_m"))
        fmt::print(", {} on the lit side; mean {:.6g} m, median {:.6g} m, largest {:.6g} m",
                   found["lit_side"].get<std::size_t>(), found["mean_m"].get<double>(), found["median_m"].get<double>(),
                   found["largest_m"].get<double>());
    if (a.compare)
        fmt::print("; off by {:.4f}% of the exact thickness", 100.0 * json["error"]["relative"].get<double>());
    fmt::print("\n");
    print_warnings(warnings);
    check_validation(renderer);
}

}  // namespace

void add_thickness_command(CLI::App& app) {
    auto arguments = std::make_shared<ThicknessArguments>();
    ThicknessArguments& a = *arguments;
    CLI::App* command = app.add_subcommand(
        "thickness", "Measure the length of solid between a light and every visible point of translucent objects");
    command->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    command->add_option("scene", a.scene, shape_help())->required()->type_name("SCENE");
    command->add_option("-o,--output", a.output, "Image: .exr, metres; below 0 where there is no thickness")
        ->required()
        ->type_name("FILE");
    command->add_option("--size", a.size, "Width and height in pixels")->capture_default_str()->type_name("WxH");
    command->add_option("--camera", a.camera, "As of render")->type_name("NAME|orbit:AZ,EL,DIST");
    add_number(*command, "--light-number", a.light, "The light, in the order of the file and then of --light, from 0")
        ->capture_default_str();
    command->add_flag("--exact", a.compare, "Say how far that is off the exact thickness, traced on the CPU");
    command->add_option("--json", a.json, "Write every measure")->type_name("FILE");
    add_translucency_options(*command, a.translucency);
    add_scene_options(*command, a.how);
    add_device_options(*command, a.device);
    command->callback([arguments] { measure(*arguments); });
}

}  // namespace pellucid::cli
