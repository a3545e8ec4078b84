#include "commands.h"
#include "options/arguments.h"
#include "options/help.h"
#include "options/light_options.h"
#include "options/named_technique.h"
#include "options/options.h"
#include "options/progress_bar.h"

#include <pellucid/file.h>
#include <pellucid/pellucid.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>

namespace pellucid::cli {
namespace {

/// The command line as given; strings are parsed when the command runs, so that errors are ours.
struct RenderArguments {
    std::string scene;
    std::string output;
    std::string technique = RenderSettings{}.technique;
    ParameterArguments parameters;
    std::string size = "512x512";
    EnvironmentArguments environment;
    std::optional<std::string> camera;
    std::optional<double> fov_deg;
    std::uint32_t samples = 1;
    std::uint32_t first_sample = 0;
    double error = 0.0;
    std::uint32_t most_samples = RenderSettings().most_samples;
    std::string tonemap = "neutral";
    double exposure_ev = 0.0;
    double unit_luminance_cd_m2 = double(RenderSettings().unit_luminance_cd_m2);
    std::string view = "radiance";
    std::string layer_builder = "automatic";
    std::vector<std::string> aovs;
    std::optional<std::string> json;
    LightArguments light;
    ThicknessArguments thickness;
    SceneArguments how;
    DeviceArguments device;
    Console console;
};

/// The camera that the arguments ask for; none: the file's first, or one that frames the scene.
std::optional<Camera> chosen_camera(const RenderArguments& arguments, const RenderSettings& settings,
                                    const Scene& scene) {
    const bool of_the_file = arguments.camera ? !arguments.camera->starts_with("orbit:") : !scene.cameras.empty();
    if (arguments.fov_deg && of_the_file) {
        throw Error("--fov: a camera of the file has its own field of view; give --camera orbit:AZ,EL,DIST with it");
    }
    const float fov = arguments.fov_deg ? glm::radians(float(*arguments.fov_deg)) : Camera{}.vertical_fov;
    if (arguments.camera) return parse_camera(*arguments.camera, scene, fov);
    if (!arguments.fov_deg) return std::nullopt;
    return framing_camera(scene_bounds(scene), settings.width, settings.height, fov);
}

RenderSettings render_settings(const RenderArguments& arguments) {
    RenderSettings settings;
    std::tie(settings.width, settings.height) = parse_size(arguments.size);
    settings.technique = arguments.technique;
    settings.parameters = given_parameters(arguments.parameters);
    settings.layer_builder = parse_layer_builder(arguments.layer_builder);
    settings.view = parse_view(arguments.view);
    settings.samples = arguments.samples;
    settings.first_sample = arguments.first_sample;
    settings.error = float(arguments.error);
    settings.most_samples = arguments.most_samples;
    settings.light = light_options(arguments.light);
    settings.thickness = thickness_settings(arguments.thickness);
    settings.photon_flux = arguments.json.has_value();
    settings.tonemap = parse_tonemap(arguments.tonemap);
    settings.exposure_ev = float(arguments.exposure_ev);
    settings.unit_luminance_cd_m2 = float(arguments.unit_luminance_cd_m2);
    for (const std::string& aov : arguments.aovs) settings.aovs.push_back(parse_aov(aov).first);
    return settings;
}

void check_render_outputs(const RenderArguments& arguments) {
    const std::string extension = lower_extension(arguments.output);
    if (extension != ".png" && extension != ".exr") {
        throw Error(fmt::format("--output: '{}': pictures are written as .png or .exr", arguments.output));
    }
    std::vector<std::string> outputs{arguments.output};
    for (const std::string& aov : arguments.aovs) outputs.push_back(parse_aov(aov).second);
    if (arguments.json) outputs.push_back(*arguments.json);
    check_outputs(outputs, {arguments.scene, arguments.environment.name_or_file});
}

/// Median over the frames of each pass's time, in the order of the passes.
std::vector<PassTime> median_times(const std::vector<std::vector<PassTime>>& frames) {
    std::vector<PassTime> medians;
    for (std::size_t pass = 0; !frames.empty() && pass < frames.front().size(); ++pass) {
        std::vector<double> times;
        for (const auto& frame : frames) times.push_back(frame[pass].time_ms);
        medians.push_back({frames.front()[pass].name, spread(std::move(times)).median});
    }
    return medians;
}

nlohmann::ordered_json rgb(const glm::dvec3& watts) { return {watts.r, watts.g, watts.b}; }

/// Light of lights on every object, by as many photons as the picture of the path tracer has, up to kMostPhotons.
nlohmann::ordered_json describe_light_flux(const nlohmann::ordered_json& parameters, std::uint32_t samples,
                                           const Tracer& tracer, const Scene& scene) {
    constexpr double kMostPhotons = 2e6;
    const double photons = std::min(parameters["photons"].get<double>() * samples, kMostPhotons);
    const std::vector<LightFlux> flux =
        tracer.light_flux(std::uint32_t(photons), std::uint32_t(parameters["seed"].get<double>()));
    auto json = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < flux.size(); ++i)
        json.push_back({{"object", scene.objects[i].name},
                        {"direct_w", rgb(flux[i].direct)},
                        {"photons_w", rgb(flux[i].photons)}});
    return json;
}

nlohmann::ordered_json describe_flux(const PhotonFlux& flux, const Scene& scene) {
    nlohmann::ordered_json json{{"sent", rgb(flux.sent)}, {"left", rgb(flux.left)}};
    for (std::size_t i = 0; i < flux.objects.size(); ++i) {
        const auto& [bent, straight] = flux.objects[i];
        if (bent == glm::dvec3(0.0) && straight == glm::dvec3(0.0)) continue;
        json["objects"].push_back({{"name", scene.objects[i].name}, {"bent", rgb(bent)}, {"straight", rgb(straight)}});
    }
    return json;
}

nlohmann::ordered_json describe(const RenderArguments& arguments, const RenderSettings& settings,
                                const NamedTechnique& technique, const Scene& scene, Renderer& renderer,
                                const RenderResult& result, const std::vector<std::string>& warnings) {
    nlohmann::ordered_json json{{"device", renderer.device().name},
                                {"driver", renderer.device().driver},
                                {"version", version()},
                                {"scene", arguments.scene},
                                {"environment", arguments.environment.name_or_file},
                                {"environment_rotation_deg", arguments.environment.rotation_deg},
                                {"environment_intensity", arguments.environment.intensity},
                                {"width", settings.width},
                                {"height", settings.height},
                                {"samples", settings.samples},
                                {"first_sample", settings.first_sample},
                                {"light", light_transport_name(result.light)},
                                {"shadows", arguments.light.shadows},
                                {"bounces", settings.light.bounces},
                                {"objects", scene.objects.size()},
                                {"triangles", scene.triangle_count()},
                                {"origin", {scene.origin.x, scene.origin.y, scene.origin.z}},
                                {"covered", result.covered},
                                {"side_conflicts", result.side_conflicts}};
    if (settings.error > 0.0f) {
        const auto& counts = result.sample_counts.pixels;
        json["samples"] = mean(result.sample_counts);
        json["error"] = settings.error;
        json["most_samples"] = *std::max_element(counts.begin(), counts.end());
    }
    if (arguments.how.animation) json["animation"] = *arguments.how.animation;
    if (arguments.how.time_s) json["time_s"] = *arguments.how.time_s;
    add_technique(json, technique);
    add_parameters(json, technique.info(), parameters_of(technique, settings.parameters));
    for (std::uint32_t status = 0; status < kStatusCount; ++status) {
        const double share = result.covered > 0 ? double(result.status[status]) / double(result.covered) : 0.0;
        json["status"][std::string(status_name(Status(status)))] = share;
    }
    if (!result.photon_flux.objects.empty()) json["photon_flux"] = describe_flux(result.photon_flux, scene);
    double frame_ms = 0.0;
    json["passes"] = nlohmann::ordered_json::object();
    for (const PassTime& pass : median_times(result.frames)) {
        json["passes"][pass.name] = {{"median", pass.time_ms}};
        frame_ms += pass.time_ms;
    }
    // Of a technique that traces on the CPU the passes are the least part.
    if (!technique.info().reference) json["frame_ms"] = frame_ms;
    if (!result.standard_error.pixels.empty()) json["cut_paths"] = result.cut_paths;
    if (technique.info().all_light && arguments.json && !scene.lights.empty())
        json["light_flux"] = describe_light_flux(json["parameters"], settings.samples, renderer.tracer(), scene);
    json["frames"] = result.frames.size();
    json["layer_passes"] = result.layer_passes;
    json["cut_rays"] = result.cut_rays;
    if (settings.tonemap == ToneMap::kKrawczyk) json["adapted_cd_m2"] = result.adapted_cd_m2;
    json["warnings"] = warnings;
    return json;
}

/// Radiance with what is known about its error: channels R, G, B, their standard errors if the technique estimates them,
/// and the samples of the pixel.
void write_estimate(const std::string& file, const RenderResult& result, std::uint32_t samples) {
    const Image &radiance = result.radiance, &error = result.standard_error, &counts = result.sample_counts;
    std::vector<std::string> names{"R", "G", "B"};
    if (!error.pixels.empty()) names.insert(names.end(), {"error.R", "error.G", "error.B"});
    names.push_back("samples");
    Image image(radiance.width, radiance.height, int(names.size()));
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            float* to = std::copy_n(radiance.at(x, y), 3, image.at(x, y));
            if (!error.pixels.empty()) to = std::copy_n(error.at(x, y), 3, to);
            *to = counts.pixels.empty() ? float(samples) : *counts.at(x, y);
        }
    }
    write_image(file, image, names);
}

void write_outputs(const RenderArguments& arguments, const RenderResult& result, const nlohmann::ordered_json& json) {
    if (lower_extension(arguments.output) != ".exr") {
        write_image(arguments.output, result.display);
    } else if (result.standard_error.pixels.empty() && result.sample_counts.pixels.empty()) {
        write_image(arguments.output, result.radiance);
    } else {
        write_estimate(arguments.output, result, arguments.samples);
    }
    for (const std::string& aov : arguments.aovs) {
        const auto [name, file] = parse_aov(aov);
        write_image(file, result.aovs.at(name));
    }
    if (!arguments.json) return;
    write_json(*arguments.json, json);
}

void render(const RenderArguments& arguments) {
    check_render_outputs(arguments);
    RenderSettings settings = render_settings(arguments);
    check_technique_name(settings.technique);  // said before any work
    const Scene scene = load_given_scene(arguments.scene, arguments.how, arguments.console);
    std::vector<std::string> warnings = scene.warnings;
    std::string environment_warning;
    const Environment environment = load_given_environment(arguments.environment, environment_warning);
    if (!environment_warning.empty()) warnings.push_back(environment_warning);

    Renderer renderer(device_options(arguments.device));
    renderer.set_scene(scene);
    const NamedTechnique technique{settings.technique, renderer.choose(settings.technique)};
    renderer.set_environment(environment);
    if (const std::optional<Camera> camera = chosen_camera(arguments, settings, scene)) renderer.set_camera(*camera);
    ProgressBar bar(arguments.console, settings.technique);
    settings.progress = bar.progress();
    const RenderResult result = renderer.render(settings);
    bar.clear();
    warnings.insert(warnings.end(), result.warnings.begin(), result.warnings.end());

    write_outputs(arguments, result, describe(arguments, settings, technique, scene, renderer, result, warnings));
    arguments.console.warn(warnings);
    check_validation(renderer);
}

}  // namespace

void add_render_command(CLI::App& app) {
    auto arguments = std::make_shared<RenderArguments>();
    RenderArguments& a = *arguments;
    CLI::App* command = app.add_subcommand("render", "Render a scene into an image");
    // A script's defaults can be overridden by what a user appends.
    command->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    command->add_option("scene", a.scene, kSceneHelp)->required()->type_name("SCENE");
    command->option_defaults()->group("Output");
    command->add_option("-o,--output", a.output, "Image: .png (tone mapped, sRGB) or .exr (linear)")
        ->required()
        ->type_name("FILE");
    command->add_option("--aov", a.aovs, "Also write this quantity per pixel; may be repeated (help aovs)")
        ->type_name("NAME=FILE.exr")
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command->add_option("--json", a.json, "Write times per pass, device, counts and warnings")->type_name("FILE");
    command->option_defaults()->group("Image");
    command->add_option("--technique", a.technique, "A preset or a technique (help presets, pellucid techniques)")
        ->capture_default_str()
        ->type_name("NAME");
    add_size_option(*command, a.size);
    add_camera_options(*command, a.camera, a.fov_deg);
    add_number(*command, "--samples", a.samples, "Jittered frames, averaged in linear light; of path: paths per pixel")
        ->capture_default_str();
    add_number(*command, "--first-sample", a.first_sample,
               "Number of the first of them: other samples have other random numbers");
    add_number(*command, "--error", a.error, "Sample each pixel until its standard error is X (help images)")
        ->check(CLI::PositiveNumber)
        ->type_name("X")
        ->excludes("--samples");
    add_number(*command, "--most-samples", a.most_samples, "Of a pixel, with --error")
        ->capture_default_str()
        ->needs("--error");
    add_display_options(*command, a.tonemap, a.exposure_ev);
    add_number(*command, "--unit-luminance", a.unit_luminance_cd_m2, "Of --tonemap krawczyk: luminance of radiance 1")
        ->capture_default_str()
        ->type_name("CD/M2");
    command->add_option("--view", a.view, "radiance, analysis or wavefront (help images)")
        ->capture_default_str()
        ->type_name("NAME");
    command
        ->add_option("--layer-builder", a.layer_builder,
                     "automatic, single-pass, compute, depth-peeling or dual-depth-peeling")
        ->capture_default_str()
        ->type_name("NAME");
    add_environment_options(*command, a.environment);
    add_light_options(*command, a.light);
    add_scene_options(*command, a.how);
    add_thickness_options(*command, a.thickness);
    add_device_options(*command, a.device);
    add_console_options(*command, a.console);
    add_parameter_options(*command, a.parameters);
    set_examples(*command, {"pellucid render model.glb -o model.png --environment studio.hdr --samples 16",
                            "pellucid render shape:goblet -o goblet.png --camera orbit:30,20,4 --fov 40",
                            "pellucid render bunny.obj -o amber.png --attenuation-color 0.9,0.5,0.1 "
                            "--attenuation-distance 0.05",
                            "pellucid render bunny.obj -o truth.exr --technique path --samples 256"});
    command->callback([arguments] { render(*arguments); });
}

}  // namespace pellucid::cli
