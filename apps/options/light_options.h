#pragma once

#include <pellucid/light_options.h>

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>

namespace pellucid::cli {

/// Options of light transport. The names are parsed when the command runs.
struct LightArguments {
    std::string transport = "automatic";
    std::string shadows = "exact";
    std::string caustics;
    std::uint32_t bounces = LightOptions().bounces;
};
void add_light_options(CLI::App& command, LightArguments& arguments);
/// Throws Error for an unknown name or a number out of range.
LightOptions light_options(const LightArguments& arguments);

}  // namespace pellucid::cli
