#include "commands.h"
#include "options/help.h"
#include "options/options.h"

#include <pellucid/error.h>
#include <pellucid/pellucid.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace pellucid::cli {
namespace {

struct InfoArguments {
    std::string scene;
    SceneArguments how;
    Console console;
    bool json = false;
};

void print_devices() {
    fmt::print("pellucid {}\n", version());
    const std::vector<DeviceInfo> devices = list_devices();
    bool usable = false;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const DeviceInfo& device = devices[i];
        fmt::print("{}: {} ({}, Vulkan {}{}{})\n", i, device.name, device.type, device.api_version,
                   device.driver.empty() ? "" : ", ", device.driver);
        for (const std::string& missing : device.missing) fmt::print("   not usable: lacks {}\n", missing);
        for (const std::string& absent : device.absent) fmt::print("   without {}\n", absent);
        usable = usable || device.missing.empty();
    }
    if (!usable) throw DeviceError("no usable Vulkan device; a software one comes with Mesa's Vulkan drivers");
    // The device itself is made as well: a driver may list a device that it then cannot open.
    fmt::print("default: {}\n", Renderer().device().name);
}

void print_json(const nlohmann::ordered_json& json) {
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

void print_devices_as_json() {
    nlohmann::ordered_json json{{"version", version()}, {"devices", nlohmann::ordered_json::array()}};
    for (const DeviceInfo& device : list_devices())
        json["devices"].push_back({{"name", device.name},
                                   {"driver", device.driver},
                                   {"type", device.type},
                                   {"api_version", device.api_version},
                                   {"missing", device.missing},
                                   {"absent", device.absent}});
    json["default"] = Renderer().device().name;
    print_json(json);
}

std::string counted(std::size_t count, const std::string& what, const std::string& plural) {
    return fmt::format("{} {}", count, count == 1 ? what : plural);
}

/// Corners of the box around the scene, in the file's world, m.
std::pair<glm::dvec3, glm::dvec3> box_of(const Scene& scene) {
    const Bounds bounds = scene_bounds(scene);
    const glm::dvec3 center = glm::dvec3(bounds.center) + scene.origin, half_size(bounds.half_size);
    return {center - half_size, center + half_size};
}

/// Names of refractive objects, each once.
std::vector<std::string> solids_of(const Scene& scene) {
    std::vector<std::string> names;
    for (const Object& object : scene.objects)
        if (scene.materials[std::size_t(object.material)].refractive() &&
            std::find(names.begin(), names.end(), object.name) == names.end())
            names.push_back(object.name);
    return names;
}

void print_scene_as_json(const std::string& source, const Scene& scene) {
    const auto [low, high] = box_of(scene);
    nlohmann::ordered_json json{{"version", version()},
                                {"scene", source},
                                {"objects", scene.objects.size()},
                                {"meshes", scene.meshes.size()},
                                {"triangles", scene.triangle_count()},
                                {"box_m", {{low.x, low.y, low.z}, {high.x, high.y, high.z}}},
                                {"origin_m", {scene.origin.x, scene.origin.y, scene.origin.z}},
                                {"solids", solids_of(scene)}};
    for (const char* list : {"cameras", "lights", "volumes", "animations"})
        json[list] = nlohmann::ordered_json::array();
    for (const Camera& camera : scene.cameras) json["cameras"].push_back(camera.name);
    for (const Light& light : scene.lights) json["lights"].push_back(light.name);
    for (const VolumeObject& object : scene.volume_objects) {
        const glm::uvec3 size = scene.volumes[std::size_t(object.volume)]->size;
        json["volumes"].push_back({{"name", object.name}, {"voxels", {size.x, size.y, size.z}}});
    }
    for (const AnimationInfo& animation : animations(scene))
        json["animations"].push_back({{"name", animation.name},
                                      {"duration_s", animation.duration_s},
                                      {"meshes", animation.meshes.size()},
                                      {"objects", animation.objects.size()}});
    json["warnings"] = scene.warnings;
    print_json(json);
}

/// What a scene holds, one thing per line; needs no device.
void print_scene(const InfoArguments& arguments) {
    const Scene scene = load_given_scene(arguments.scene, arguments.how, arguments.console);
    if (arguments.json) return print_scene_as_json(arguments.scene, scene);
    const Bounds bounds = scene_bounds(scene);
    const glm::dvec3 center = glm::dvec3(bounds.center) + scene.origin;
    const auto [low, high] = box_of(scene);
    // Six digits of what the box measures, however far away it stands.
    const bool moved = scene.origin != glm::dvec3(0.0);
    const int digits =
        moved ? 6 + int(std::clamp(std::log10(glm::length(center) / double(bounds.radius)), 0.0, 9.0)) : 6;
    fmt::print("{}: {}, {}, {}\n", arguments.scene, counted(scene.objects.size(), "object", "objects"),
               counted(scene.meshes.size(), "mesh", "meshes"),
               counted(scene.triangle_count(), "triangle", "triangles"));
    fmt::print("box: {:.{}g} {:.{}g} {:.{}g} to {:.{}g} {:.{}g} {:.{}g} m\n", low.x, digits, low.y, digits, low.z,
               digits, high.x, digits, high.y, digits, high.z, digits);
    if (moved)
        fmt::print("origin: {:.17g} {:.17g} {:.17g} m, subtracted from all positions\n", scene.origin.x, scene.origin.y,
                   scene.origin.z);
    for (const Camera& camera : scene.cameras) fmt::print("camera: {}\n", one_line(camera.name));
    if (scene.objects.size() > 1) {
        const std::vector<std::string> names = solids_of(scene);
        if (!names.empty()) fmt::print("solids: {}\n", fmt::join(names, ", "));
    }
    for (const VolumeObject& object : scene.volume_objects) {
        const glm::uvec3 size = scene.volumes[std::size_t(object.volume)]->size;
        fmt::print("volume: {}, {} x {} x {} voxels\n", one_line(object.name), size.x, size.y, size.z);
    }
    for (const Light& light : scene.lights) fmt::print("light: {}\n", one_line(light.name));
    const std::vector<AnimationInfo> known = animations(scene);
    for (std::size_t i = 0; i < known.size(); ++i)
        fmt::print("animation {}: {}, {:.6g} s, deforms {}, moves {}\n", i, one_line(known[i].name),
                   known[i].duration_s, counted(known[i].meshes.size(), "mesh", "meshes"),
                   counted(known[i].objects.size(), "object", "objects"));
    arguments.console.warn(scene.warnings);
}

}  // namespace

void add_info_command(CLI::App& app) {
    auto arguments = std::make_shared<InfoArguments>();
    CLI::App* command =
        app.add_subcommand("info", "Print the Vulkan devices found and what they lack, or what a scene holds");
    command->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    CLI::Option* const scene = command->add_option("scene", arguments->scene, kSceneHelp)->type_name("SCENE");
    add_scene_options(*command, arguments->how);
    for (CLI::Option* const option : command->get_options())
        if (option != scene && option != command->get_help_ptr()) option->needs(scene);
    add_console_options(*command, arguments->console);
    command->add_flag("--json", arguments->json, "Print JSON");
    set_examples(*command, {"pellucid info", "pellucid info model.glb --time 1", "pellucid info model.glb --json"});
    command->callback([arguments, scene] {
        if (scene->count() > 0) return print_scene(*arguments);
        arguments->json ? print_devices_as_json() : print_devices();
    });
}

}  // namespace pellucid::cli
