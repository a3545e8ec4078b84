#pragma once

#include "viewer/document.h"
#include "viewer/inspector.h"
#include "viewer/picture.h"

#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace pellucid::viewer {

/// Actions requested by a button or a key.
struct Wishes {
    bool undo = false, redo = false, save = false, copy_command = false, frame = false, screenshot = false,
         close = false, cancel = false;
    std::string open, environment;  ///< scenes and files to open; empty: none
};

/// A file being loaded.
struct LoadingProgress {
    std::string name;
    double seconds = 0.0;  ///< elapsed time
};

/// Values that the panels display but do not change.
struct Facts {
    const Renderer* renderer;
    const PictureInfo* left;
    const PictureInfo* right;  ///< null: there is no divider
    const std::deque<float>* frame_times_ms;
    const InspectedRay* ray;  ///< null: none
    std::optional<LoadingProgress> loading;
};

/// Panels over the image, with all settings and measurements.
class Panels {
public:
    bool visible = true;
    bool help = false;
    bool playing = false;
    float speed = 1.0f;  ///< speed factor of the animation

    /// Draws the panels of one frame, and changes the document's look.
    void draw(Document& document, const Facts& facts, Wishes& wishes);
    /// Shows a line: an error until the user closes it, other messages for a while.
    void say(const std::string& line, bool is_error);
    const std::string& message() const { return message_; }
    void clear_message() { message_.clear(); }
    /// Seconds until the panels change without input; negative: never.
    double seconds_to_change() const;

private:
    void scene_section(Document& document, Wishes& wishes);
    /// Horizontal range of the window, pixels.
    struct Strip {
        float left, right;
    };
    void draw_panel(Document& document, const Facts& facts, Wishes& wishes);
    void draw_message(Strip strip, bool has_scene, const std::optional<LoadingProgress>& loading, Wishes& wishes);
    void draw_help(Strip strip, float height);

    std::string message_;
    bool message_is_error_ = false;
    double message_until_s_ = 0.0;
    float panel_right_ = 0.0f, message_height_ = 0.0f;  ///< pixels, at the last drawing
    bool collapsed_ = false;                            ///< whether the panel is collapsed
    std::string path_, environment_path_;
};

/// Keys and their actions, for the help window and the documentation.
struct KeyHelp {
    const char* keys;
    const char* does;
};
const std::vector<KeyHelp>& key_help();

}  // namespace pellucid::viewer
