#pragma once

#include "viewer/gui.h"
#include "viewer/input.h"
#include "viewer/panels.h"
#include "viewer/picture.h"
#include "viewer/stage.h"
#include "viewer/window.h"

#include <chrono>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pellucid::viewer {

/// The window, the renderer and the document, and one turn of the loop that ties them.
class Viewer {
public:
    Viewer(const cli::DeviceArguments& device, std::uint32_t width, std::uint32_t height);

    Document& document() { return document_; }
    Panels& panels() { return panels_; }
    Window& window() { return window_; }
    Gpu& gpu() { return gpu_; }
    const PictureInfo& info() const { return left_.info(); }

    /// Replaces the scene. Throws Error, and changes nothing, if it cannot be loaded.
    void load(const std::string& source, const cli::SceneArguments& how = {});
    /// Opens a scene (model, shape, volume) or an environment. What fails is shown as a message; the old scene stays. True: it
    /// was opened.
    bool open(const std::string& source);
    bool open_environment(const std::string& name_or_file);
    void undo();
    void redo();
    void frame();
    void inspect(glm::ivec2 window_pixel);

    /// Handles events and draws what there is to draw. `wait`: waits a while for an event where there is nothing to do.
    void turn(bool wait);
    /// Nothing moves, and the image has all of its samples.
    bool still() const;
    /// What the window shows now, RGB 0..1. Empty where it has no pixels.
    Image screenshot();
    /// The image without panels, RGB 0..1.
    Image image();
    std::string command_line();

    std::uint64_t frames() const { return frames_; }  ///< images drawn so far
    const std::deque<float>& frame_times_ms() const { return frame_times_ms_; }
    /// From a change of the look until the window has an image of it, of the last changes.
    const std::deque<float>& response_times_ms() const { return response_times_ms_; }

private:
    using Clock = std::chrono::steady_clock;
    void advance_animation();
    void update_pictures();
    bool take_pictures();
    void submit_pictures();
    void finish_pictures();
    void draw_window(Image* capture);
    bool update_overlay();
    void note_response(Clock::time_point start);
    void draw_ray();
    void grant(const Wishes& wishes);
    void save(const Image& image, const char* stem);
    void try_to(const std::function<void()>& action);
    std::vector<ShownImage> shown_images() const;
    bool moving() const;

    Glfw glfw_;
    Gpu gpu_;
    Window window_;
    Gui gui_;
    Renderer renderer_;
    vulkan::Frames frames_of_renderer_;
    Document document_;
    Stage stage_;
    Panels panels_;
    Input input_;
    Picture left_, right_;
    bool left_turn_ = true;  ///< whose frame comes next where there is a divider

    DeviceImage overlay_;
    std::optional<Look> overlay_look_;  ///< that the overlay is of; none: there is none
    std::uint64_t overlay_revision_ = 0;

    Look seen_;  ///< of the last turn
    vk::Extent2D seen_extent_;
    Clock::time_point moved_at_{}, turned_at_ = Clock::now();
    std::uint64_t revision_ = 0;
    std::uint64_t frames_ = 0;
    std::deque<float> frame_times_ms_;
    /// When the look changed: of what no frame is in flight yet, of the frame in flight, and of the frame to be shown.
    std::optional<Clock::time_point> changed_at_, shows_change_of_, response_to_;
    std::deque<float> response_times_ms_;
    std::optional<InspectedRay> ray_;
    int turns_to_draw_ = 3;  ///< Dear ImGui shows some things a frame late
};

}  // namespace pellucid::viewer
