#pragma once

// Options that several commands share.

#include "options/arguments.h"
#include "options/console.h"
#include "options/translucency_options.h"
#include "options/volume_options.h"

#include <pellucid/pellucid.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace pellucid::cli {

/// An option with a finite number; the parser's own conversion takes "" and "nan".
template <class Number>
CLI::Option* add_number(CLI::App& command, const std::string& flag, Number& number, const std::string& help) {
    return command.add_option(flag, number, help)
        ->check([name = flag.substr(0, flag.find(','))](const std::string& text) {
            parse_number(name, text);
            return std::string();
        })
        ->type_name(std::is_integral_v<Number> ? "N" : "X");
}

/// How scenes are loaded. Strings are parsed when the command runs, so that errors are ours.
struct SceneArguments {
    std::optional<double> ior;
    std::optional<std::string> attenuation_color;
    std::optional<double> attenuation_distance;
    std::optional<double> crease_angle_deg;
    bool remake_normals = false;
    bool solid = false;
    bool allow_outside = false;
    std::vector<std::string> priorities;
    std::optional<std::string> animation;
    std::optional<double> time_s;
    TranslucencyArguments translucency;
    VolumeArguments volumes;
};
void add_scene_options(CLI::App& command, SceneArguments& arguments);
/// All but --map and what --add-light and --add-volume add.
LoadOptions load_options(const SceneArguments& arguments);
/// load_scene(), and the lights and volumes that the command line adds.
Scene load_given_scene(const std::string& source, const SceneArguments& arguments, const Console& console);

inline constexpr const char* kAllowOutsideHelp =
    "Read images, buffers and material libraries outside the scene's folder, too";

/// Positional argument of commands that load a scene.
inline constexpr const char* kSceneHelp = "A file, shape:NAME or volume:NAME (help scenes, shapes, volumes)";

struct DeviceArguments {
    std::string device;
    std::uint32_t threads = 0;
    bool validate = false;
};
void add_device_options(CLI::App& command, DeviceArguments& arguments);
DeviceOptions device_options(const DeviceArguments& arguments);

/// Every parameter of every technique, by name.
using ParameterArguments = std::map<std::string, std::optional<double>>;
/// One flag for each parameter name of the registry, which takes numbers and the names of values.
void add_parameter_options(CLI::App& command, ParameterArguments& arguments);
/// A number, or the name of a value that a parameter `name` of some technique has. Throws Error otherwise.
double parse_parameter(const std::string& name, const std::string& text);
/// Those that were given.
ParameterMap given_parameters(const ParameterArguments& arguments);

void add_size_option(CLI::App& command, std::string& size);
/// --camera and --fov.
void add_camera_options(CLI::App& command, std::optional<std::string>& camera, std::optional<double>& fov_deg);
/// --tonemap and --exposure.
void add_display_options(CLI::App& command, std::string& tonemap, double& exposure_ev);

/// Light from infinitely far away, as given.
struct EnvironmentArguments {
    std::string name_or_file = "studio";
    double rotation_deg = 0.0;
    double intensity = 1.0;
};
void add_environment_options(CLI::App& command, EnvironmentArguments& arguments);
/// load_environment(), turned and scaled. `warning` as there.
Environment load_given_environment(const EnvironmentArguments& arguments, std::string& warning);

/// Says before any work what could not be written after it. Throws Error for a file that cannot be written,
/// that is one of `inputs`, or that is given for two outputs.
void check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

bool is_in_folder(const std::filesystem::path& file, const std::filesystem::path& folder);

/// The arguments with which others can repeat a measurement, each after a blank: files by their names, the folder of
/// models as DIR, without the files that are written, and without the option `left_out`.
std::string arguments_without_folders(const CLI::App& command, const CLI::Option* left_out = nullptr);

/// As text with a line feed at its end. Names inside files need not be UTF-8, as JSON must: what is not is replaced.
void write_json(const std::string& file, const nlohmann::ordered_json& json);

/// Throws std::runtime_error, a bug of ours, if the validation layer has said anything.
void check_validation(const Renderer& renderer);

}  // namespace pellucid::cli
