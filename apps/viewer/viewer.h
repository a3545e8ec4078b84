#pragma once

#include "viewer/background_load.h"
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

/// Called inside a catch block with an error's message. Empty: the window shows the message.
using OnFailure = std::function<void(const std::string& why)>;

/// Arguments of opening a scene.
struct Opening {
    cli::SceneArguments how{};
    std::function<void()> then{};  ///< called once the scene is shown; may be empty
    OnFailure failed{};
};

/// The window, the renderer and the document, and one turn of the main loop.
class Viewer {
public:
    Viewer(const cli::DeviceArguments& device, std::uint32_t width, std::uint32_t height);
    ~Viewer();

    Document& document() { return document_; }
    Panels& panels() { return panels_; }
    Window& window() { return window_; }
    Gpu& gpu() { return gpu_; }
    const PictureInfo& info() const { return left_.info(); }

    /// Opens a scene (model, shape, volume) or an environment in the background, and replaces any pending load. The
    /// current one stays until then, and on failure.
    void open(const std::string& source, Opening opening = {});
    void open_environment(const std::string& name_or_file, OnFailure failed = {});
    void cancel_loading();
    bool loading() const;
    void undo();
    void redo();
    void frame();
    void inspect(glm::ivec2 window_pixel);

    /// Handles events and draws if necessary. `wait`: without work, wait a while for an event.
    void turn(bool wait);
    /// True if nothing moves and the image has all its samples.
    bool still() const;
    /// The pixels of the window, RGB 0..1; empty for a window without pixels.
    Image screenshot();
    /// The image without panels, RGB 0..1.
    Image image();
    std::string command_line();

    std::uint64_t frames() const { return frames_; }  ///< number of frames drawn so far
    /// Vulkan objects that the renderer has created so far.
    vulkan::Made made() const { return frames_of_renderer_.made(); }
    /// Longest time without event handling since the last call, ms.
    double take_longest_turn_ms() { return std::exchange(longest_turn_ms_, 0.0); }
    const std::deque<float>& frame_times_ms() const { return frame_times_ms_; }
    /// Latencies of the last changes of the look until the window showed them, ms.
    const std::deque<float>& response_times_ms() const { return response_times_ms_; }

private:
    using Clock = std::chrono::steady_clock;
    void take_loaded();
    void show(LoadedScene loaded);
    void load_environment();
    void advance_animation();
    void update_pictures();
    bool take_pictures();
    void submit_pictures();
    void finish_pictures();
    void draw_window(Image* capture);
    bool update_overlay();
    void note_response(Clock::time_point start);
    void draw_divider();
    void grant(const Wishes& wishes);
    void save(const Image& image, const char* stem);
    void attempt(const std::function<void()>& action, const OnFailure& failed = {});
    void draw_and_listen();
    double patience_s(bool wait) const;
    std::optional<LoadingProgress> progress() const;
    bool pictures_still() const;
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
    bool left_turn_ = true;  ///< with a divider: the left picture draws next

    DeviceImage overlay_;
    std::optional<Look> overlay_look_;  ///< the overlay's look; empty: no overlay
    std::uint64_t overlay_revision_ = 0;

    BackgroundLoad<LoadedScene> scene_load_;
    BackgroundLoad<LoadedEnvironment> environment_load_;
    Opening opening_;
    OnFailure environment_failed_;

    Look seen_;  ///< look of the last turn
    vk::Extent2D seen_extent_;
    Clock::time_point moved_at_{}, turned_at_ = Clock::now(), drawn_at_{};
    double longest_turn_ms_ = 0.0;
    std::uint64_t revision_ = 0;
    std::uint64_t frames_ = 0;
    std::deque<float> frame_times_ms_;
    /// Time of a change of the look: not yet in flight, in flight, and about to be shown.
    std::optional<Clock::time_point> changed_at_, shows_change_of_, response_to_;
    std::deque<float> response_times_ms_;
    std::optional<InspectedRay> ray_;
    static constexpr int kLateTurns = 3;  ///< Dear ImGui shows some changes a few frames late
    int turns_to_draw_ = kLateTurns;
};

}  // namespace pellucid::viewer
