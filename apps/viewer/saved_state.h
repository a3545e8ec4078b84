#pragma once

#include "viewer/look.h"

#include <filesystem>
#include <optional>
#include <string>

namespace pellucid::viewer {

/// The state that the viewer stores between sessions.
struct SavedState {
    std::string scene;  ///< source for load_scene()
    std::uint32_t width = 960, height = 540;
    bool panels = true;
    Look look;
};

/// $XDG_STATE_HOME/pellucid/viewer.json, or ~/.local/state/pellucid/viewer.json; empty if neither variable is set.
std::filesystem::path state_file();

std::string to_json(const SavedState& state);
/// Parses a saved state; missing values keep their defaults. Throws Error for text that is no saved state.
SavedState from_json(const std::string& text);

}  // namespace pellucid::viewer
