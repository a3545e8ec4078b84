#pragma once

#include "viewer/document.h"
#include "viewer/inspector.h"
#include "viewer/picture.h"

#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace pellucid::viewer {

/// Actions that the user has asked for by a button or a key.
struct Wishes {
    bool undo = false, redo = false, save = false, copy_command = false, frame = false, screenshot = false,
         close = false, cancel = false;
    std::string open, environment;  ///< scenes and files to open; empty: none
};

/// A file that is being loaded.
struct LoadingProgress {
    std::string name;
    double seconds = 0.0;  ///< so far
};

/// Values that the panels show and do not change.
struct Facts {
    const Renderer* renderer;
    const PictureInfo* left;
    const PictureInfo* right;  ///< null: no divider
    const std::deque<float>* frame_times_ms;
    const InspectedRay* ray;  ///< null: none
    std::optional<LoadingProgress> loading;
};

/// Panels above the image: everything that can be set and everything that is known.
class Panels {
public:
    bool visible = true;
    bool help = false;
    bool playing = false;
    float speed = 1.0f;  ///< of the animation

    /// Draws the panels of one frame and changes the look of the document.
    void draw(Document& document, const Facts& facts, Wishes& wishes);
    /// Shows a line until the user closes it, or for a while if it is no error.
    void say(const std::string& line, bool is_error);
    const std::string& message() const { return message_; }
    void clear_message() { message_.clear(); }
    /// Seconds until what is shown changes by itself; negative: it does not.
    double seconds_to_change() const;

private:
    void scene_section(Document& document, Wishes& wishes);
    /// Pixels of the window, from left to right.
    struct Strip {
        float left, right;
    };
    void draw_panel(Document& document, const Facts& facts, Wishes& wishes);
    void draw_message(Strip strip, bool has_scene, const std::optional<LoadingProgress>& loading, Wishes& wishes);
    void draw_help(Strip strip, float height);

    std::string message_;
    bool message_is_error_ = false;
    double message_until_s_ = 0.0;
    float panel_right_ = 0.0f, message_height_ = 0.0f;  ///< pixels, when they were drawn last
    bool collapsed_ = false;                            ///< the panel
    std::string path_, environment_path_;
};

/// Keys and what they do, for the help window and the documentation.
struct KeyHelp {
    const char* keys;
    const char* does;
};
const std::vector<KeyHelp>& key_help();

}  // namespace pellucid::viewer
