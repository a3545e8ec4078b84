#pragma once

#include "viewer/gpu.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

struct GLFWwindow;

namespace pellucid::viewer {

/// GLFW, for the lifetime of this object. Throws Error if there is no display.
class Glfw {
public:
    Glfw();
    ~Glfw();
    Glfw(const Glfw&) = delete;
    Glfw& operator=(const Glfw&) = delete;
};

/// A part of an image in TRANSFER_SRC_OPTIMAL, stretched over a rectangle of the window.
struct ShownImage {
    vk::Image image;
    vk::Rect2D from;   ///< texels
    vk::Rect2D where;  ///< pixels of the window
};

/// A window and its swapchain.
class Window {
public:
    Window(Gpu& gpu, const std::string& title, std::uint32_t width, std::uint32_t height);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    GLFWwindow* handle() const { return window_; }
    bool should_close() const;
    void close();
    void set_title(const std::string& title);
    void resize(std::uint32_t width, std::uint32_t height);
    void minimize();
    void restore();
    /// Handles pending events, after waiting up to `wait_s` seconds for one. Returns true if there were any.
    bool handle_events(double wait_s);
    /// Size in pixels; 0 by 0 if minimised.
    vk::Extent2D extent() const;
    /// Files dropped since the last call.
    std::vector<std::filesystem::path> take_dropped();

    vk::RenderPass overlay_pass() const { return *overlay_pass_; }
    std::uint32_t image_count() const { return std::uint32_t(images_.size()); }

    /// Draws the images on black, and over them the commands of `overlay`, recorded inside overlay_pass(). Waits for
    /// the window's frame before the last. Does nothing if the window has no pixels. `capture` receives the window's
    /// content, RGB 0..1.
    void draw(std::span<const ShownImage> images, const std::function<void(vk::CommandBuffer)>& overlay,
              Image* capture = nullptr);
    /// Waits until the device has read the images of all earlier draw() calls.
    void wait_for_reads();

private:
    struct Frame {
        vk::raii::CommandBuffer commands = nullptr;
        vk::raii::Fence done = nullptr;
        vk::raii::Semaphore acquired = nullptr;
    };
    struct SwapImage {
        vk::Image image;
        vk::raii::ImageView view = nullptr;
        vk::raii::Framebuffer framebuffer = nullptr;
        vk::raii::Semaphore drawn = nullptr;
    };
    void make_overlay_pass();
    void make_frames();
    bool make_swapchain();
    void record(const Frame& frame, const SwapImage& to, std::span<const ShownImage> images,
                const std::function<void(vk::CommandBuffer)>& overlay, const HostBuffer* capture);
    void wait_for(const Frame& frame);

    Gpu& gpu_;
    GLFWwindow* window_ = nullptr;
    bool events_ = false;
    std::vector<std::filesystem::path> dropped_;
    vk::raii::SurfaceKHR surface_ = nullptr;
    vk::Format format_ = vk::Format::eB8G8R8A8Unorm;
    vk::raii::RenderPass overlay_pass_ = nullptr;
    vk::raii::SwapchainKHR swapchain_ = nullptr;
    vk::Extent2D extent_;  ///< extent of the swapchain
    bool stale_ = true;    ///< the swapchain does not match the window
    std::vector<SwapImage> images_;
    vk::raii::CommandPool pool_ = nullptr;
    std::vector<Frame> frames_;
    std::size_t next_frame_ = 0;
};

}  // namespace pellucid::viewer
