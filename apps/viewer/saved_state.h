#pragma once

#include "viewer/look.h"

#include <filesystem>
#include <optional>
#include <string>

namespace pellucid::viewer {

/// The state that the viewer keeps between two starts.
struct SavedState {
    std::string scene;  ///< as load_scene() takes it
    std::uint32_t width = 960, height = 540;
    bool panels = true;
    Look look;
};

/// $XDG_STATE_HOME/pellucid/viewer.json, or ~/.local/state/pellucid/viewer.json; empty if neither variable is set.
std::filesystem::path state_file();

std::string to_json(const SavedState& state);
/// Missing values keep their defaults. Throws Error for text that no viewer has written.
SavedState from_json(const std::string& text);

}  // namespace pellucid::viewer
