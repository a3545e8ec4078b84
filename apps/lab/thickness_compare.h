#pragma once

#include "options/options.h"
#include "options/translucency_options.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pellucid::cli {

/// What `pellucid compare --thickness` is asked for.
struct ThicknessComparison {
    std::vector<std::string> scenes;
    std::string size;
    ThicknessArguments thickness;  ///< its method is not looked at: all are compared
    std::optional<std::string> pictures, json;
    SceneArguments how;
    DeviceArguments device;
    Console console;
};

/// Every method against the exact thickness, for every light, from behind, from the side and from the top: a table,
/// and pictures of thickness and error where they are asked for.
void compare_thickness(const ThicknessComparison& comparison);

}  // namespace pellucid::cli
