#pragma once

#include "viewer/window.h"

namespace pellucid::viewer {

/// Dear ImGui in a window, for the lifetime of this object. ImGui writes no files of its own.
class Gui {
public:
    Gui(Gpu& gpu, Window& window);
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    void begin_frame();
    /// Ends the frame; record() draws it.
    void end_frame();
    void record(vk::CommandBuffer commands);

private:
    Gpu& gpu_;
    vk::raii::DescriptorPool pool_ = nullptr;
};

}  // namespace pellucid::viewer
