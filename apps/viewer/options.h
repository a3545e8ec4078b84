#pragma once

#include "options/options.h"
#include "viewer/document.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace pellucid::viewer {

/// The command line as given; strings are parsed when the program runs, so that errors are ours.
struct Options {
    std::string scene;  ///< empty: what was open last
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

    /// State is read and written: neither --fresh nor a script nor a screenshot.
    bool keeps_state() const { return !fresh && script.empty() && screenshot.empty(); }
    bool environment_given() const { return app->count("--environment") > 0; }
    /// Throws Error for what no scene makes right.
    void check() const;
    /// Puts what was given into the look of the document, except for the environment.
    void apply(Document& document) const;

    const CLI::App* app = nullptr;  ///< tells what was given
};
void add_options(CLI::App& app, Options& options);

}  // namespace pellucid::viewer
