#include "options/options.h"

#include "options/help.h"
#include "options/progress_bar.h"

#include <pellucid/file.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

namespace pellucid::cli {
namespace {

namespace fs = std::filesystem;

bool same_file(const fs::path& a, const fs::path& b) {
    std::error_code error;
    if (fs::equivalent(a, b, error)) return true;
    return fs::weakly_canonical(fs::absolute(a, error), error) == fs::weakly_canonical(fs::absolute(b, error), error);
}

LoadOptions::Priority parse_priority(const std::string& text) {
    const std::size_t equals = text.rfind('=');
    if (equals == std::string::npos || equals == 0)
        throw Error(fmt::format("--priority {}: must be OBJECT=N, such as rod=1", text));
    const double number = parse_number("--priority", text.substr(equals + 1));
    if (number != std::round(number) || std::abs(number) > 1e6)
        throw Error(fmt::format("--priority {}: the number must be whole, within +-1000000", text));
    return {text.substr(0, equals), int(number)};
}

}  // namespace

void add_scene_options(CLI::App& command, SceneArguments& arguments) {
    command.option_defaults()->group("Scene");
    add_number(command, "--ior", arguments.ior, "Index of refraction of all glass");
    command
        .add_option("--attenuation-color", arguments.attenuation_color,
                    "What glass leaves of white light after the distance, 0 to 1")
        ->type_name("R,G,B");
    add_number(command, "--attenuation-distance", arguments.attenuation_distance,
               "Metres of glass after which that is left")
        ->type_name("M");
    add_number(command, "--crease-angle", arguments.crease_angle_deg,
               "Edges bent less than this look smooth, 0 to 180 degrees (help scenes)")
        ->check(CLI::Range(0.0, 180.0))
        ->type_name("DEG");
    command.add_flag("--remake-normals", arguments.remake_normals, "Replace the normals that a mesh file brings along");
    command.add_flag("--solid", arguments.solid,
                     "Closed glTF meshes of transmissive materials are solid glass, also without a volume");
    command.add_flag("--allow-outside", arguments.allow_outside, kAllowOutsideHelp);
    command
        .add_option("--priority", arguments.priorities,
                    "Which solid displaces others where they overlap; may be repeated (help scenes)")
        ->type_name("OBJECT=N")
        ->allow_extra_args(false);
    command
        .add_option("--animation", arguments.animation,
                    "Animation whose pose is shown; 'pellucid info SCENE' lists them (help scenes)")
        ->type_name("NAME|N");
    add_number(command, "--time", arguments.time_s, "Time in the animation, s, from 0 (default 0)")->type_name("S");
    add_translucency_options(command, arguments.translucency);
    add_volume_options(command, arguments.volumes);
}

Scene load_given_scene(const std::string& source, const SceneArguments& arguments, const Console& console) {
    const ProgressBar bar(console, fmt::format("load {}", source));
    parse_lights(arguments.translucency, glm::dvec3(0.0));  // wrong ones are reported before any work
    Scene scene = load_scene(source, with_grids(load_options(arguments), source, arguments.volumes));
    add_volumes(scene, arguments.volumes);
    const std::vector<Light> lights = parse_lights(arguments.translucency, scene.origin);
    scene.lights.insert(scene.lights.end(), lights.begin(), lights.end());
    return scene;
}

LoadOptions load_options(const SceneArguments& arguments) {
    LoadOptions options;
    if (arguments.ior) options.ior = float(*arguments.ior);
    if (arguments.attenuation_color) {
        const auto color = parse_numbers("--attenuation-color", *arguments.attenuation_color, 3);
        options.attenuation_color = glm::vec3(float(color[0]), float(color[1]), float(color[2]));
    }
    if (arguments.attenuation_distance) options.attenuation_distance = float(*arguments.attenuation_distance);
    if (arguments.crease_angle_deg) options.crease_angle = glm::radians(float(*arguments.crease_angle_deg));
    options.remake_normals = arguments.remake_normals;
    options.solid = arguments.solid;
    options.allow_outside = arguments.allow_outside;
    for (const std::string& text : arguments.priorities) options.priorities.push_back(parse_priority(text));
    options.translucent = parse_translucency(arguments.translucency);
    options.animation = arguments.animation;
    options.time_s = arguments.time_s;
    return options;
}

void add_device_options(CLI::App& command, DeviceArguments& arguments) {
    command.option_defaults()->group(kGeneralGroup);
    command
        .add_option("--device", arguments.device, "Vulkan device: its number in 'pellucid info' or a part of its name")
        ->type_name("DEVICE");
    add_number(command, "--threads", arguments.threads, "Threads of what is traced or baked on the CPU; 0: all cores")
        ->capture_default_str();
    command.add_flag("--validate", arguments.validate, "Run with the Vulkan validation layer; a message is an error");
}

DeviceOptions device_options(const DeviceArguments& arguments) {
    return {.device = arguments.device, .validation = arguments.validate, .threads = arguments.threads};
}

double parse_parameter(const std::string& name, const std::string& text) {
    std::vector<std::string_view> known;
    for (const TechniqueInfo* technique : techniques()) {
        for (const ParameterInfo& parameter : technique->parameters) {
            if (parameter.name != name) continue;
            for (const NamedValue& value : parameter.names) {
                if (value.name == text) return value.value;
                if (std::find(known.begin(), known.end(), value.name) == known.end()) known.push_back(value.name);
            }
        }
    }
    // A word is meant as a name where there are names.
    if (!known.empty() && !text.empty() && std::isalpha(static_cast<unsigned char>(text.front())) && text != "nan" &&
        text != "inf")
        throw Error(fmt::format("--{}: {}, or a number", name, unknown_name("value", text, known).what()));
    return parse_number("--" + name, text);
}

void add_parameter_options(CLI::App& command, ParameterArguments& arguments) {
    command.option_defaults()->group(kParameterGroup);
    for (const TechniqueInfo* technique : techniques()) {
        for (const ParameterInfo& parameter : technique->parameters) {
            const std::string name(parameter.name);
            if (!arguments.try_emplace(name).second) continue;
            command
                .add_option_function<std::string>(
                    "--" + name,
                    [&arguments, name](const std::string& text) { arguments[name] = parse_parameter(name, text); },
                    std::string(parameter.doc))
                ->type_name(!parameter.names.empty() ? "NAME|N"
                            : parameter.whole        ? "N"
                                                     : "X");
        }
    }
}

ParameterMap given_parameters(const ParameterArguments& arguments) {
    ParameterMap parameters;
    for (const auto& [name, value] : arguments) {
        if (value) parameters[name] = *value;
    }
    return parameters;
}

void add_size_option(CLI::App& command, std::string& size) {
    command.add_option("--size", size, "Width and height in pixels")->capture_default_str()->type_name("WxH");
}

void add_camera_options(CLI::App& command, std::optional<std::string>& camera, std::optional<double>& fov_deg) {
    command.add_option("--camera", camera, "A camera of the file, or orbit:AZ,EL,DIST[,X,Y,Z] (help cameras)")
        ->type_name("CAMERA");
    add_number(command, "--fov", fov_deg,
               "Vertical field of view of other cameras than the file's, degrees (default 30)")
        ->check(CLI::Range(1.0, 170.0))
        ->type_name("DEG");
}

void add_display_options(CLI::App& command, std::string& tonemap, double& exposure_ev) {
    command.add_option("--tonemap", tonemap, "none, reinhard, aces, neutral or krawczyk (help images)")
        ->capture_default_str()
        ->type_name("NAME");
    add_number(command, "--exposure", exposure_ev, "Exposure in stops")->capture_default_str()->type_name("EV");
}

void add_environment_options(CLI::App& command, EnvironmentArguments& arguments) {
    command.option_defaults()->group("Light");
    command
        .add_option("--environment", arguments.name_or_file,
                    "studio, checker, sky, uniform, or an equirectangular .hdr or .exr file")
        ->capture_default_str()
        ->type_name("NAME|FILE");
    add_number(command, "--environment-rotation", arguments.rotation_deg,
               "Turn of the environment about +Y, degrees (help environments)")
        ->capture_default_str()
        ->type_name("DEG");
    add_number(command, "--environment-intensity", arguments.intensity, "Factor of the environment's radiance")
        ->capture_default_str()
        ->check(CLI::NonNegativeNumber)
        ->type_name("X");
}

Environment load_given_environment(const EnvironmentArguments& arguments, std::string& warning) {
    Environment environment = load_environment(arguments.name_or_file, &warning);
    // Whole turns are taken off in double precision.
    environment.rotation = float(glm::radians(std::remainder(arguments.rotation_deg, 360.0)));
    environment.intensity = float(arguments.intensity);
    return environment;
}

bool is_in_folder(const std::filesystem::path& file, const std::filesystem::path& folder) {
    std::error_code error;
    const auto relative = std::filesystem::weakly_canonical(file, error)
                              .lexically_relative(std::filesystem::weakly_canonical(folder, error));
    return !relative.empty() && *relative.begin() != "..";
}

void check_outputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
    const auto is_one_of = [](const std::string& file, auto begin, auto end) {
        return std::any_of(begin, end, [&](const std::string& other) { return same_file(other, file); });
    };
    for (auto output = outputs.begin(); output != outputs.end(); ++output) {
        check_writable(*output);
        if (is_one_of(*output, inputs.begin(), inputs.end()))
            throw Error(fmt::format("{}: would overwrite what is read", *output));
        if (is_one_of(*output, outputs.begin(), output))
            throw Error(fmt::format("{}: is given for two outputs", *output));
    }
}

std::string arguments_without_folders(const CLI::App& command, const CLI::Option* left_out) {
    std::string line;
    for (const CLI::Option* option : command.get_options()) {
        if (option == left_out || option->count() == 0 || option->check_lname("json") ||
            option->check_lname("report") || option->check_lname("again"))
            continue;
        if (!option->get_positional()) line += " --" + option->get_lnames().front();
        if (option->get_items_expected_max() == 0) continue;  // a flag
        for (const std::string& value : option->reduced_results())
            line += " " + (option->check_lname("models") ? "DIR" : std::filesystem::path(value).filename().string());
    }
    return line;
}

void write_json(const std::string& file, const nlohmann::ordered_json& json) {
    write_text_file(file, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

void check_validation(const Renderer& renderer) {
    const std::vector<std::string>& messages = renderer.validation_messages();
    if (messages.empty()) return;
    throw std::runtime_error(fmt::format("{} validation messages, the first: {}", messages.size(), messages.front()));
}

}  // namespace pellucid::cli
