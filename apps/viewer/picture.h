#pragma once

#include "viewer/frame_pace.h"
#include "viewer/gpu.h"

#include <pellucid/pellucid.h>
#include <pellucid/vulkan.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace pellucid::viewer {

/// Facts about the image of a Picture.
struct PictureInfo {
    std::uint32_t samples = 0, samples_wanted = 0;
    bool moving = false;             ///< drawn during motion
    Pace pace{};                     ///< resolution and technique
    std::uint64_t pace_changes = 0;  ///< changes of the pace so far
    double frame_ms = 0.0;           ///< time from submission until the viewer noticed completion
    double still_ms = 0.0;           ///< time from the first submission of the last finished image to its last sample
    std::vector<PassTime> passes;
    std::vector<std::string> warnings;
    std::vector<std::string> overflows;
};

/// Draws the scene of a renderer with one technique, into images for a window: during motion at a lower resolution,
/// then sample by sample.
class Picture {
public:
    /// Several pictures may share `frames` in turns: one must finish before the next begins.
    Picture(Gpu& gpu, vulkan::Frames& frames);

    /// Sets the wanted image. `revision` increases when the scene, its camera or its environment changes.
    void want(const RenderSettings& settings, bool moving, std::uint64_t revision);
    /// Takes a finished frame. Returns true if there is a new image to show. Throws Error if the image cannot be
    /// drawn.
    bool take();
    /// Submits the next frame, if one is needed and none is in flight. `wait_for_reads` waits until previously shown
    /// images are no longer read.
    void submit(const std::function<void()>& wait_for_reads);
    /// Waits for the frame in flight.
    void finish();
    bool in_flight() const { return flight_.has_value(); }
    /// True if the wanted image is complete, or cannot be drawn.
    bool still() const;

    bool has_image() const { return shown_.has_value(); }
    vk::Image image() const { return *targets_[*shown_].image; }
    vk::Extent2D extent() const { return shown_extent_; }  ///< the image occupies these first texels
    Image read(Gpu& gpu) const;
    const PictureInfo& info() const { return info_; }

private:
    using Clock = std::chrono::steady_clock;
    struct Flight {
        vulkan::Ticket ticket;
        std::size_t target;
        vk::Extent2D extent;
        Pace pace;
        bool still;
        std::uint64_t generation;
        Clock::time_point start;
    };
    bool stays_equal(const RenderSettings& settings) const;

    Gpu& gpu_;
    vulkan::Frames& frames_;
    FramePace pace_;
    std::array<DeviceImage, 3> targets_;
    std::optional<RenderSettings> wanted_;
    bool moving_ = false;
    std::uint64_t revision_ = 0;
    std::uint64_t generation_ = 0;  ///< increases with every change that requires a new image
    std::optional<Flight> flight_;
    std::optional<std::size_t> shown_;
    vk::Extent2D shown_extent_;
    std::uint64_t shown_generation_ = 0;
    bool shown_still_ = false;
    std::uint64_t failed_generation_ = 0;
    Clock::time_point still_start_{};  ///< submission of the first sample of the finished image
    PictureInfo info_;
};

}  // namespace pellucid::viewer
