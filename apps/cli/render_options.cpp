#include "render_options.h"

#include <pellucid/file.h>

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace pellucid::cli {
namespace {

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

}  // namespace

void add_image_options(CLI::App& command, RenderArguments& a) {
    command.option_defaults()->group("Image");
    command.add_option("--technique", a.technique, "A preset or a technique (help presets, pellucid techniques)")
        ->capture_default_str()
        ->type_name("NAME");
    add_size_option(command, a.size);
    add_camera_options(command, a.camera, a.fov_deg);
    add_number(command, "--samples", a.samples, "Jittered frames, averaged in linear light; of path: paths per pixel")
        ->capture_default_str();
    add_number(command, "--first-sample", a.first_sample,
               "Number of the first of them: other samples have other random numbers");
    add_number(command, "--error", a.error, "Sample each pixel until its standard error is X (help images)")
        ->check(CLI::PositiveNumber)
        ->type_name("X")
        ->excludes("--samples");
    add_number(command, "--most-samples", a.most_samples, "Of a pixel, with --error")
        ->capture_default_str()
        ->needs("--error");
    add_display_options(command, a.tonemap, a.exposure_ev);
    add_number(command, "--unit-luminance", a.unit_luminance_cd_m2, "Of --tonemap krawczyk: luminance of radiance 1")
        ->capture_default_str()
        ->type_name("CD/M2");
    command.add_option("--view", a.view, "radiance, analysis or wavefront (help images)")
        ->capture_default_str()
        ->type_name("NAME");
    command
        .add_option("--layer-builder", a.layer_builder,
                    "automatic, single-pass, compute, depth-peeling or dual-depth-peeling")
        ->capture_default_str()
        ->type_name("NAME");
    add_environment_options(command, a.environment);
    add_light_options(command, a.light);
    add_scene_options(command, a.how);
    add_thickness_options(command, a.thickness);
    add_device_options(command, a.device);
    add_console_options(command, a.console);
    add_parameter_options(command, a.parameters);
}

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

void check_picture_name(const std::string& file) {
    const std::string extension = lower_extension(file);
    if (extension != ".png" && extension != ".exr")
        throw Error(fmt::format("--output: '{}': pictures are written as .png or .exr", file));
}

void write_picture(const std::string& file, const RenderResult& result, std::uint32_t samples) {
    if (lower_extension(file) != ".exr") {
        write_image(file, result.display);
    } else if (result.standard_error.pixels.empty() && result.sample_counts.pixels.empty()) {
        write_image(file, result.radiance);
    } else {
        write_estimate(file, result, samples);
    }
}

}  // namespace pellucid::cli
