#pragma once

#include "viewer/panels.h"

namespace pellucid::viewer {

/// Moves the camera and the divider, and grants keys, from one frame to the next.
class Input {
public:
    /// To be called between Gui::begin_frame() and Gui::end_frame(), after the panels. `inspect` gets a pixel of the window
    /// whose ray is wanted, or a negative one where none is wanted any more.
    void handle(Document& document, Panels& panels, Wishes& wishes, std::optional<glm::ivec2>& inspect);
    /// A button is held that changes the look: no step of the history yet.
    bool dragging() const { return dragging_; }
    /// A key is held that moves the camera on.
    bool flying() const { return flying_; }

private:
    void handle_mouse(Document& document, std::optional<glm::ivec2>& inspect);
    void handle_keys(Document& document, Panels& panels, Wishes& wishes, std::optional<glm::ivec2>& inspect);

    bool dragging_ = false, flying_ = false;
    bool divider_held_ = false;
    std::string last_other_ = "exact";
};

}  // namespace pellucid::viewer
