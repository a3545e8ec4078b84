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

/// Facts about the image that a Picture shows.
struct PictureInfo {
    std::uint32_t samples = 0, samples_wanted = 0;
    bool moving = false;             ///< drawn while something moved
    Pace pace{};                     ///< resolution and technique
    std::uint64_t pace_changes = 0;  ///< so far
    double frame_ms = 0.0;           ///< from its submission until the viewer knew that it had run
    double still_ms = 0.0;           ///< from the first submission of the last finished image to its last sample
    std::vector<PassTime> passes;
    std::vector<std::string> warnings;
    std::vector<std::string> overflows;
};

/// Draws the scene of a renderer by one technique, into images that a window shows: while something moves at a lower
/// resolution, then sample by sample.
class Picture {
public:
    /// Frames may be shared by several pictures, which take turns: one of them is finished before the next begins.
    Picture(Gpu& gpu, vulkan::Frames& frames);

    /// Sets what the image shows. `revision` ascends when the scene, its camera or its environment change.
    void want(const RenderSettings& settings, bool moving, std::uint64_t revision);
    /// Takes what has been drawn. True: there is another image to show. Throws Error for what cannot be drawn.
    bool take();
    /// Lets the next frame be drawn, if there is one to draw and none in flight. `wait_for_reads` waits until nothing reads
    /// images that were shown before.
    void submit(const std::function<void()>& wait_for_reads);
    /// Waits for the frame in flight.
    void finish();
    bool in_flight() const { return flight_.has_value(); }
    /// The image has everything that was wanted, or cannot be drawn.
    bool still() const;

    bool has_image() const { return shown_.has_value(); }
    vk::Image image() const { return *targets_[*shown_].image; }
    vk::Extent2D extent() const { return shown_extent_; }  ///< the image's first texels
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
    std::uint64_t generation_ = 0;  ///< ascends with whatever makes another image
    std::optional<Flight> flight_;
    std::optional<std::size_t> shown_;
    vk::Extent2D shown_extent_;
    std::uint64_t shown_generation_ = 0;
    bool shown_still_ = false;
    std::uint64_t failed_generation_ = 0;
    Clock::time_point still_start_{};  ///< of the first sample of the finished image
    PictureInfo info_;
};

}  // namespace pellucid::viewer
