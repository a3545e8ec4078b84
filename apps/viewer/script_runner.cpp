#include "viewer/script_runner.h"

#include "options/arguments.h"
#include "viewer/overlay.h"

#include <pellucid/file.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <utility>

#include <unistd.h>

namespace pellucid::viewer {
namespace {

/// Turns until the viewer has noticed the changes of the previous line.
constexpr int kTurnsToNotice = 3;

/// Commands that do not wait for loading.
constexpr std::string_view kWhileLoading[]{"cancel", "mark", "screenshot", "wait"};

bool on_off(const std::string& word) {
    if (word != "on" && word != "off") throw Error(fmt::format("'{}' is neither on nor off", word));
    return word == "on";
}

std::uint64_t resident_bytes() {
    std::ifstream file("/proc/self/statm");
    std::uint64_t whole = 0, resident = 0;
    file >> whole >> resident;
    return resident * std::uint64_t(sysconf(_SC_PAGESIZE));
}

void write_report(const std::string& file, Viewer& viewer) {
    const PictureInfo& info = viewer.info();
    const vulkan::Made made = viewer.made();
    const vk::Extent2D extent = viewer.window().extent();
    nlohmann::ordered_json json{
        {"scene", viewer.document().scene().source},
        {"width", extent.width},
        {"height", extent.height},
        {"frames", viewer.frames()},
        {"samples", info.samples},
        {"made", {{"allocations", made.allocations}, {"pipelines", made.pipelines}, {"pools", made.pools}}},
        {"longest_turn_ms", viewer.take_longest_turn_ms()},
        {"still_ms", info.still_ms},
        {"scale", info.pace.scale},
        {"coarse", info.pace.coarse},
        {"pace_changes", info.pace_changes},
        {"frame_times_ms", viewer.frame_times_ms()},
        {"response_times_ms", viewer.response_times_ms()},
        {"resident_bytes", resident_bytes()},
        {"message", viewer.panels().message()},
        {"warnings", info.warnings}};
    json["validation_messages"] = viewer.gpu().validation_messages();
    write_text_file(file, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

void set_material(const ScriptLine& line, Document& document) {
    auto& materials = document.look.materials;
    const double index = number_at(line, 0);
    if (!(index >= 0.0 && index < double(materials.size())))
        throw Error(fmt::format("the scene has {} materials", materials.size()));
    MaterialLook& look = materials[std::size_t(index)];
    const std::string& property = line.arguments[1];
    const auto color = [&] {
        if (line.arguments.size() != 5) throw Error(fmt::format("{} has three values", property));
        return glm::vec3(float(number_at(line, 2)), float(number_at(line, 3)), float(number_at(line, 4)));
    };
    if (property == "ior")
        look.ior = float(number_at(line, 2));
    else if (property == "dispersion")
        look.dispersion = float(number_at(line, 2));
    else if (property == "roughness")
        look.roughness = float(number_at(line, 2));
    else if (property == "attenuation-distance")
        look.attenuation_distance = float(number_at(line, 2));
    else if (property == "attenuation-color")
        look.attenuation_color = color();
    else if (property == "color")
        look.base_color = color();
    else
        throw Error(
            fmt::format("unknown property '{}'; known: ior, dispersion, roughness, attenuation-distance, "
                        "attenuation-color, color",
                        property));
}

void set_camera(const std::string& name, Document& document) {
    for (const Camera& camera : document.scene().cameras) {
        if (camera.name != name) continue;
        document.look.file_camera = name;
        return;
    }
    throw Error(fmt::format("unknown camera '{}'", name));
}

/// Runs lines that change the look. Returns false for other lines.
bool change_look(const ScriptLine& line, Viewer& viewer) {
    Document& document = viewer.document();
    Look& look = document.look;
    const auto& words = line.arguments;
    const auto number = [&](std::size_t i) { return float(number_at(line, i)); };
    const auto moved = [&]() -> OrbitCamera& {
        if (!std::exchange(look.file_camera, {}).empty())
            look.camera = orbit_from_camera(document.scene().cameras.front(), document.bounds());
        return look.camera;
    };
    const std::string& command = line.command;
    if (command == "orbit")
        turn(moved(), number(0), number(1));
    else if (command == "zoom")
        zoom(moved(), std::max(number(0), 1e-3f));
    else if (command == "pan")
        pan(moved(), document.bounds(), number(0), number(1));
    else if (command == "fly")
        fly(moved(), document.bounds(), {number(0), number(1), number(2)});
    else if (command == "camera")
        set_camera(words[0], document);
    else if (command == "technique")
        check_technique_name(words[0]), look.technique = words[0];
    else if (command == "split") {
        if (words[0] != "off") check_technique_name(words[0]);
        look.other = words[0] == "off" ? "" : words[0];
        if (words.size() > 1) look.divider = std::clamp(number(1), 0.0f, 1.0f);
    } else if (command == "set")
        look.parameters[words[0]] = number_at(line, 1);
    else if (command == "samples")
        look.samples = std::uint32_t(std::clamp(number_at(line, 0), 1.0, 65536.0));
    else if (command == "view")
        look.view = parse_view(words[0]);
    else if (command == "overlay")
        look.overlay = words[0] == "off" ? "" : find_overlay(words[0]).name;
    else if (command == "exposure")
        look.exposure_ev = number(0);
    else if (command == "tonemap")
        look.tonemap = parse_tonemap(words[0]);
    else if (command == "light")
        look.transport = parse_light_transport(words[0]);
    else if (command == "environment-rotation")
        look.environment_rotation_deg = number_at(line, 0);
    else if (command == "environment-intensity")
        look.environment_intensity = std::max(0.0, number_at(line, 0));
    else if (command == "material")
        set_material(line, document);
    else if (command == "animation") {
        if (words[0] == "off")
            look.animation.reset();
        else
            look.animation = find_animation(document.scene(), words[0]);
    } else if (command == "time")
        look.time_s = std::max(0.0, number_at(line, 0));
    else
        return false;
    document.commit();
    return true;
}

/// Runs lines about the window and output files. Returns false for other lines.
bool use_window(const ScriptLine& line, Viewer& viewer) {
    const auto& words = line.arguments;
    const std::string& command = line.command;
    if (command == "open")
        viewer.open(words[0]);
    else if (command == "drop")
        for (const std::string& file : words) viewer.open(file);
    else if (command == "environment")
        viewer.open_environment(words[0]);
    else if (command == "frame")
        viewer.frame();
    else if (command == "cancel")
        viewer.cancel_loading();
    else if (command == "undo")
        viewer.undo();
    else if (command == "redo")
        viewer.redo();
    else if (command == "play")
        viewer.panels().playing = on_off(words[0]);
    else if (command == "panels")
        viewer.panels().visible = on_off(words[0]);
    else if (command == "help")
        viewer.panels().help = on_off(words[0]);
    else if (command == "inspect")
        viewer.inspect({int(number_at(line, 0)), int(number_at(line, 1))});
    else if (command == "size") {
        const auto [width, height] = cli::parse_size(words[0]);
        viewer.window().resize(width, height);
    } else if (command == "minimize")
        viewer.window().minimize();
    else if (command == "restore")
        viewer.window().restore();
    else if (command == "mark")
        write_text_file(words[0], "");
    else if (command == "screenshot")
        write_image(words[0], viewer.screenshot());
    else if (command == "save")
        write_image(words[0], viewer.image());
    else if (command == "command")
        write_text_file(words[0], viewer.command_line());
    else if (command == "report")
        write_report(words[0], viewer);
    else if (command == "close")
        viewer.window().close();
    else
        return false;
    return true;
}

}  // namespace

void ScriptRunner::step(Viewer& viewer) {
    while (!done() && !viewer.window().should_close()) {
        const ScriptLine& line = lines_[next_];
        try {
            if (!run(line, viewer)) return;
        } catch (const Error& error) {
            throw Error(fmt::format("{}:{}: {}: {}", name_, line.number, line.command, error.what()));
        }
        ++next_;
    }
}

/// Runs a line. Returns false if it must wait.
bool ScriptRunner::run(const ScriptLine& line, Viewer& viewer) {
    const bool any_time = std::ranges::find(kWhileLoading, line.command) != std::end(kWhileLoading);
    if (viewer.loading() && !any_time) return false;
    if (line.command == "wait") return waited(line, viewer);
    const std::string& message = viewer.panels().message();
    if (line.command == "expect-message") {
        if (message.find(line.arguments[0]) == std::string::npos)
            throw Error(fmt::format("the message is '{}'", message));
        return true;
    }
    if (line.command == "expect-no-message") {
        if (!message.empty()) throw Error(fmt::format("the message is '{}'", message));
        return true;
    }
    if (!change_look(line, viewer) && !use_window(line, viewer)) throw Error("is not there yet");
    return true;
}

bool ScriptRunner::waited(const ScriptLine& line, Viewer& viewer) {
    const std::string& what = line.arguments[0];
    bool over = false;
    if (what == "still") {
        over = ++turns_ > kTurnsToNotice && viewer.still();
    } else if (what == "frames" && line.arguments.size() == 2) {
        if (!waits_for_frame_) waits_for_frame_ = viewer.frames() + std::uint64_t(std::max(0.0, number_at(line, 1)));
        over = viewer.frames() >= *waits_for_frame_;
    } else if (what == "seconds" && line.arguments.size() == 2) {
        const auto now = std::chrono::steady_clock::now();
        if (!waits_until_) waits_until_ = now + std::chrono::microseconds(std::int64_t(1e6 * number_at(line, 1)));
        over = now >= *waits_until_;
    } else if (what == "file" && line.arguments.size() == 2) {
        over = std::filesystem::exists(line.arguments[1]);
    } else {
        throw Error("should be: wait still|frames N|seconds S|file FILE");
    }
    if (!over) return false;
    turns_ = 0;
    waits_for_frame_.reset();
    waits_until_.reset();
    return true;
}

}  // namespace pellucid::viewer
