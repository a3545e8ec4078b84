#pragma once

#include "viewer/panels.h"

namespace pellucid::viewer {

/// Moves the camera and the divider, and handles keys, once per frame.
class Input {
public:
    /// Call it between Gui::begin_frame() and Gui::end_frame(), after the panels. `inspect` receives the window pixel
    /// whose ray the user wants, or a negative one to remove the ray.
    void handle(Document& document, Panels& panels, Wishes& wishes, std::optional<glm::ivec2>& inspect);
    /// True while a held button changes the look, which is no step of the history yet.
    bool dragging() const { return dragging_; }
    /// True while a held key moves the camera.
    bool flying() const { return flying_; }

private:
    void handle_mouse(Document& document, std::optional<glm::ivec2>& inspect);
    void handle_keys(Document& document, Panels& panels, Wishes& wishes, std::optional<glm::ivec2>& inspect);

    bool dragging_ = false, flying_ = false;
    bool divider_held_ = false;
    std::string last_other_ = "exact";
};

}  // namespace pellucid::viewer
