#include "commands.h"
#include "options/arguments.h"
#include "options/help.h"
#include "options/light_options.h"
#include "options/named_technique.h"
#include "options/options.h"
#include "options/progress_bar.h"
#include "render_options.h"

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

void check_render_outputs(const RenderArguments& arguments) {
    check_picture_name(arguments);
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

void write_outputs(const RenderArguments& arguments, const RenderResult& result, const nlohmann::ordered_json& json) {
    write_picture(arguments.output, arguments, result);
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
    add_image_options(*command, a);
    set_examples(*command, {"pellucid render model.glb -o model.png --environment studio.hdr --samples 16",
                            "pellucid render shape:goblet -o goblet.png --camera orbit:30,20,4 --fov 40",
                            "pellucid render bunny.obj -o amber.png --attenuation-color 0.9,0.5,0.1 "
                            "--attenuation-distance 0.05",
                            "pellucid render bunny.obj -o truth.exr --technique path --samples 256"});
    command->callback([arguments] { render(*arguments); });
}

}  // namespace pellucid::cli
