#pragma once

#include "options/light_options.h"
#include "options/options.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pellucid::cli {

/// `pellucid compare` as given; strings are parsed when the command runs, so that errors are ours.
struct CompareArguments {
    std::vector<std::string> scenes;
    std::string techniques;  ///< empty: all that the device offers
    std::string size = "512x512";
    int views = 4;
    std::uint32_t samples = 4;
    std::uint32_t exact_events = ExactSettings{}.max_events;
    std::string truth = "path";
    std::optional<std::uint32_t> truth_samples;  ///< none: as many as the differences between techniques need
    EnvironmentArguments environment;
    std::string tonemap = "neutral";
    double exposure_ev = 0.0;
    std::optional<std::string> json;
    std::optional<std::string> html;
    bool thickness = false;
    std::optional<std::string> pictures;
    ThicknessArguments thickness_how;
    LightArguments light;
    SceneArguments how;
    DeviceArguments device;
    Console console;
    ParameterArguments parameters;
    std::string command_line;
};
void add_compare_options(CLI::App& command, CompareArguments& arguments);

}  // namespace pellucid::cli
