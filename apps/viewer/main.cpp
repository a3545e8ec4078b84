#include "options/help.h"
#include "viewer/options.h"
#include "viewer/saved_state.h"
#include "viewer/script_runner.h"

#include <pellucid/file.h>
#include <pellucid/pellucid.h>

#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

namespace pellucid::viewer {
namespace {

constexpr int kDone = 0;
constexpr int kBug = 1;
constexpr int kBadInput = 2;
constexpr int kNoDevice = 3;

int complain(const std::string& message, int exit_code) {
    std::fputs(fmt::format("pellucid-view: {}\n", one_line(message)).c_str(), stderr);
    return exit_code;
}

volatile std::sig_atomic_t asked_to_end = 0;
void end_soon(int) { asked_to_end = 1; }

std::optional<std::string> read_text(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return std::nullopt;
    return std::string(std::istreambuf_iterator<char>(stream), {});
}

std::optional<ScriptRunner> script_of(const Options& options) {
    if (options.script.empty()) return std::nullopt;
    const std::optional<std::string> text = read_text(options.script);
    if (!text) throw Error(fmt::format("{}: cannot be read", options.script));
    try {
        return ScriptRunner(parse_script(*text), options.script);
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", options.script, error.what()));
    }
}

/// The state that the last start has kept, if it is wanted and can be read.
std::optional<SavedState> saved_state(const Options& options) {
    if (!options.keeps_state() || state_file().empty()) return std::nullopt;
    const std::optional<std::string> text = read_text(state_file());
    if (!text) return std::nullopt;
    try {
        return from_json(*text);
    } catch (const Error& error) {
        complain(fmt::format("warning: {}: {}", state_file().string(), error.what()), 0);
        return std::nullopt;
    }
}

void save_state(const Options& options, Viewer& viewer) {
    const std::filesystem::path file = state_file();
    const vk::Extent2D extent = viewer.window().extent();
    if (!options.keeps_state() || file.empty() || extent.width == 0 || viewer.document().scene_number() == 0) return;
    const Scene& scene = viewer.document().scene();
    const bool is_file = scene.source.find(':') == std::string::npos;
    try {
        std::filesystem::create_directories(file.parent_path());
        write_text_file(file,
                        to_json({.scene = is_file ? std::filesystem::absolute(scene.source).string() : scene.source,
                                 .width = extent.width,
                                 .height = extent.height,
                                 .panels = viewer.panels().visible,
                                 .look = viewer.document().look}));
    } catch (const std::exception& error) {
        complain(fmt::format("warning: the state was not kept: {}", error.what()), 0);
    }
}

/// Starts to open what the command line names, or else what was open last.
void open_first(const Options& options, const std::optional<SavedState>& state, Viewer& viewer) {
    const OnFailure give_up = [](const std::string&) { throw; };
    Document& document = viewer.document();
    options.check();
    if (state) {
        viewer.panels().visible = state->panels;
        document.look = state->look;
    }
    if (options.environment_given())
        viewer.open_environment(options.environment.name_or_file, give_up);
    else if (state)
        viewer.open_environment(state->look.environment);
    const auto apply = [&options, &document] {
        options.apply(document);
        document.commit();
    };
    const auto open_or_give_up = [&viewer, apply, give_up](const std::string& source, const cli::SceneArguments& how) {
        viewer.open(source, {.how = how, .then = apply, .failed = give_up});
    };
    if (!options.scene.empty() || !state) {
        open_or_give_up(options.scene.empty() ? "shape:goblet" : options.scene, options.how);
        return;
    }
    const auto restore = [&document, look = state->look, apply] {
        if (document.fits(look)) {
            const std::string environment = document.look.environment;
            document.look = look;
            document.look.environment = environment;
        }
        apply();
    };
    const auto open_goblet = [&viewer, open_or_give_up](const std::string& why) {
        open_or_give_up("shape:goblet", {});
        viewer.panels().say(why, true);
    };
    viewer.open(state->scene, {.then = restore, .failed = open_goblet});
}

int run(const Options& options) {
    std::optional<ScriptRunner> script = script_of(options);
    const std::optional<SavedState> state = saved_state(options);
    auto [width, height] = cli::parse_size(options.size.value_or("960x540"));
    if (state && !options.size) width = state->width, height = state->height;
    if (!options.screenshot.empty()) check_writable(options.screenshot);
    // A viewer that is ended keeps its state as one that is closed.
    std::signal(SIGTERM, &end_soon);
    std::signal(SIGINT, &end_soon);
    Viewer viewer(options.device, width, height);
    open_first(options, state, viewer);
    if (options.no_panels) viewer.panels().visible = false;

    int turns = 0;
    while (!viewer.window().should_close() && !asked_to_end) {
        viewer.turn(!script && options.screenshot.empty());
        if (script) {
            if (viewer.document().scene_number() > 0) script->step(viewer);
            if (script->done()) break;
        } else if (!options.screenshot.empty() && ++turns > 3 && viewer.still()) {
            write_image(options.screenshot, viewer.screenshot());
            break;
        }
    }
    save_state(options, viewer);
    if (const auto messages = viewer.gpu().validation_messages(); !messages.empty())
        throw std::runtime_error(
            fmt::format("{} validation messages, the first: {}", messages.size(), messages.front()));
    return kDone;
}

int run_or_complain(int argc, char** argv) {
    CLI::App app{"Shows transparent objects and lets one look around.", "pellucid-view"};
    cli::use_short_help(app);
    Options options;
    add_options(app, options);
    try {
        app.parse(argc, argv);
        return run(options);
    } catch (const CLI::Success& help) {
        return app.exit(help);
    } catch (const CLI::ParseError& error) {
        const std::string unknown = cli::unknown_option(app, argc, argv);
        return complain(fmt::format("{} (see 'pellucid-view --help')", unknown.empty() ? error.what() : unknown),
                        kBadInput);
    } catch (const Error& error) {
        return complain(error.what(), kBadInput);
    } catch (const DeviceError& error) {
        return complain(error.what(), kNoDevice);
    } catch (const vk::SystemError& error) {
        return complain(fmt::format("Vulkan: {}", error.what()), kNoDevice);
    } catch (const std::bad_alloc&) {
        return complain("out of memory", kBadInput);
    } catch (const std::exception& error) {
        return complain(fmt::format("internal error: {}", error.what()), kBug);
    }
}

}  // namespace
}  // namespace pellucid::viewer

int main(int argc, char** argv) {
    const int code = pellucid::viewer::run_or_complain(argc, argv);
    // Files may still be loading that nobody waits for.
    std::fflush(nullptr);
    std::_Exit(code);
}
