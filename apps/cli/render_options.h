#pragma once

// Options of an image, for the commands that render images.

#include "options/light_options.h"
#include "options/options.h"

#include <pellucid/pellucid.h>

#include <CLI/CLI.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pellucid::cli {

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
    std::optional<std::string> multilayer;
    std::optional<std::string> json;
    LightArguments light;
    ThicknessArguments thickness;
    SceneArguments how;
    DeviceArguments device;
    Console console;
};

/// All but the positional scene and the files.
void add_image_options(CLI::App& command, RenderArguments& arguments);

/// The camera that the arguments ask for; none: the file's first, or one that frames the scene.
std::optional<Camera> chosen_camera(const RenderArguments& arguments, const RenderSettings& settings,
                                    const Scene& scene);

RenderSettings render_settings(const RenderArguments& arguments);

/// Throws Error if the output is neither .png nor .exr, or has layers and is no .exr.
void check_picture_name(const RenderArguments& arguments);
/// The displayed image (.png), or the radiance with what is known about its error, and with its layers (.exr).
void write_picture(const std::string& file, const RenderArguments& arguments, const RenderResult& result);

}  // namespace pellucid::cli
