#pragma once

#include "options/options.h"
#include "viewer/document.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace pellucid::viewer {

/// The command line as given. Strings are parsed when the program runs, so that this program reports the errors.
struct Options {
    std::string scene;  ///< empty: the scene of the last session
    std::optional<std::string> size;
    std::string technique = RenderSettings{}.technique;
    cli::ParameterArguments parameters;
    cli::EnvironmentArguments environment;
    std::optional<std::string> camera;
    std::optional<double> fov_deg;
    std::uint32_t samples = Look{}.samples;
    std::string tonemap = "neutral";
    double exposure_ev = 0.0;
    cli::SceneArguments how;
    cli::DeviceArguments device;
    std::string screenshot, script;
    bool no_panels = false;
    bool fresh = false;

    /// True if state is read and written: without --fresh, script and screenshot.
    bool keeps_state() const { return !fresh && script.empty() && screenshot.empty(); }
    bool environment_given() const { return app->count("--environment") > 0; }
    /// Throws Error for values that are invalid for any scene.
    void check() const;
    /// Applies the given options to the look of the document, except for the environment.
    void apply(Document& document) const;

    const CLI::App* app = nullptr;  ///< knows which options were given
};
void add_options(CLI::App& app, Options& options);

}  // namespace pellucid::viewer
