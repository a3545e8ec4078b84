#include "render_options.h"

#include <pellucid/file.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <set>
#include <sstream>
#include <tuple>

namespace pellucid::cli {
namespace {

/// Channels of an .exr file, which are images of their own here.
class Channels {
public:
    void add(const Image& image, const std::vector<std::string>& names) {
        images_.push_back(&image);
        names_.insert(names_.end(), names.begin(), names.end());
    }
    void write(const std::string& file) const {
        Image all(images_.front()->width, images_.front()->height, int(names_.size()));
        for (int y = 0; y < all.height; ++y)
            for (int x = 0; x < all.width; ++x) {
                float* to = all.at(x, y);
                for (const Image* image : images_) to = std::copy_n(image->at(x, y), image->channels, to);
            }
        write_image(file, all, names_);
    }

private:
    std::vector<const Image*> images_;
    std::vector<std::string> names_;
};

/// Names by which compositing programs know the channels of a layer: colours have R, G and B, vectors X, Y and Z, and a depth
/// Z alone.
std::vector<std::string> layer_channels(const std::string& aov, int channels) {
    static const std::set<std::string, std::less<>> kColors{"emitted", "direct", "caustic", "indirect"};
    const std::string letters = channels == 1 && aov.find("depth") != aov.npos ? "Z"
                                : kColors.contains(aov)                        ? "RGB"
                                                                               : "XYZ";
    std::vector<std::string> names;
    for (std::size_t k = 0; k < std::size_t(channels); ++k) names.push_back(fmt::format("{}.{}", aov, letters[k]));
    return names;
}

std::vector<std::string> layers_of(const RenderArguments& arguments) {
    std::vector<std::string> layers;
    std::istringstream names(arguments.multilayer.value_or(""));
    for (std::string name; std::getline(names, name, ',');)
        if (std::find(layers.begin(), layers.end(), name) == layers.end()) layers.push_back(name);
    return layers;
}

}  // namespace

void add_image_options(CLI::App& command, RenderArguments& a) {
    command.option_defaults()->group("Output");
    command.add_option("--multilayer", a.multilayer, "Of -o: these quantities as layers of the .exr (help aovs)")
        ->type_name("A,B,..");
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
    settings.aovs = layers_of(arguments);
    for (const std::string& aov : arguments.aovs) settings.aovs.push_back(parse_aov(aov).first);
    return settings;
}

void check_picture_name(const RenderArguments& arguments) {
    const std::string extension = lower_extension(arguments.output);
    if (extension != ".png" && extension != ".exr")
        throw Error(fmt::format("--output: '{}': pictures are written as .png or .exr", arguments.output));
    if (arguments.multilayer && extension != ".exr")
        throw Error(fmt::format("--multilayer: '{}': only .exr has layers", arguments.output));
}

void write_picture(const std::string& file, const RenderArguments& arguments, const RenderResult& result) {
    if (lower_extension(file) != ".exr") return write_image(file, result.display);
    Channels channels;
    channels.add(result.radiance, {"R", "G", "B"});
    Image counts = result.sample_counts;
    if (!result.standard_error.pixels.empty()) {
        channels.add(result.standard_error, {"error.R", "error.G", "error.B"});
        if (counts.pixels.empty()) {
            counts = Image(result.radiance.width, result.radiance.height, 1);
            std::fill(counts.pixels.begin(), counts.pixels.end(), float(arguments.samples));
        }
    }
    // Programs take a channel without a layer for one of the image's colours.
    if (!counts.pixels.empty()) channels.add(counts, {arguments.multilayer ? "samples.X" : "samples"});
    for (const std::string& layer : layers_of(arguments)) {
        const Image& image = result.aovs.at(layer);
        channels.add(image, layer_channels(layer, image.channels));
    }
    channels.write(file);
}

}  // namespace pellucid::cli
