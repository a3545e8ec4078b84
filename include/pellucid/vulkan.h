#pragma once

// Pellucid on a Vulkan device of the caller's. The only public header with Vulkan's types.
#include <pellucid/api.h>
#include <pellucid/device.h>
#include <pellucid/refracted_path.h>

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace pellucid {
class Renderer;
struct RenderSettings;
enum class LightTransport;
}  // namespace pellucid

namespace pellucid::vulkan {

/// What a device has to be created with: what Pellucid cannot do without, and of the rest what the device has. A caller with
/// features and extensions of its own turns on these as well. May be moved, not copied.
class PELLUCID_API DeviceFeatures {
public:
    /// Throws DeviceError, naming what is missing, if Pellucid cannot use the device.
    DeviceFeatures(VkInstance instance, VkPhysicalDevice physical_device);
    ~DeviceFeatures();
    DeviceFeatures(DeviceFeatures&&) noexcept;
    DeviceFeatures& operator=(DeviceFeatures&&) noexcept;

    /// For VkDeviceCreateInfo::pNext: this structure and a chain of others, which live as long as this object.
    const VkPhysicalDeviceFeatures2* features() const;
    std::span<const char* const> extensions() const;
    /// A queue family that does graphics and compute, as Pellucid needs it.
    std::uint32_t queue_family() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// A device of the caller's. All of it outlives the Renderer that draws on it, which destroys none of it.
///
/// Vulkan has a queue used by one thread at a time: while a function of the Renderer runs, the caller leaves `queue` alone.
/// Pellucid waits for its own work on the queue before it returns, and for that of nobody else.
struct LentDevice {
    VkInstance instance = VK_NULL_HANDLE;  ///< made for Vulkan 1.3 or later
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;  ///< does graphics and compute
    std::uint32_t queue_family = 0;  ///< of `queue`
    /// What `device` was made with; read in the constructor of the Renderer only. What is not needed (DeviceFeatures) and
    /// not turned on is not used: info `absent` of Renderer::device() says what happens instead.
    const VkPhysicalDeviceFeatures2* features = nullptr;
    std::span<const char* const> extensions;
    /// Locked around every use of `queue`, if given: Frames::submit() uses it from a thread of its own. Whoever else uses the
    /// queue locks it, too.
    std::mutex* queue_mutex = nullptr;
};

/// An image of the caller's that a frame is drawn to: two-dimensional, one sample, of usage TRANSFER_DST.
struct Target {
    VkImage image = VK_NULL_HANDLE;
    /// R8G8B8A8 or B8G8R8A8, UNORM or SRGB: RenderResult::display, with alpha 1. R32G32B32A32_SFLOAT: RenderResult::radiance,
    /// the mean of the samples that the picture has so far.
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    VkOffset2D offset{0, 0};                           ///< of the frame's first texel
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  ///< before the frame; UNDEFINED: what the image holds may go
    VkImageLayout layout_after = VK_IMAGE_LAYOUT_GENERAL;
};

/// What the caller has drawn of the same view, which Pellucid's scene stands in: it hides what lies behind it, and is seen
/// through glass and in it where the picture shows it (Wyman 2005). It throws no shadow on Pellucid's objects, and has none
/// from them. Both images are of the frame's size and usage TRANSFER_SRC, and keep their layouts.
struct Background {
    /// RGB, scene-linear radiance, in a format that can be blitted; where nothing was drawn, the caller's sky.
    VkImage color = VK_NULL_HANDLE;
    VkImageLayout color_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    VkImage depth = VK_NULL_HANDLE;  ///< D32_SFLOAT
    VkImageLayout depth_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    /// Rows z and w of the caller's projection, by z along the view's axis, m, negative ahead: clip z = zz z + zw,
    /// clip w = wz z + ww. In a column-major matrix these are elements 10, 14, 11 and 15.
    float zz = 0.0f, zw = 0.0f, wz = -1.0f, ww = 0.0f;
    float far_depth = 1.0f;  ///< of texels where nothing was drawn: 1, or 0 where depth is reversed
};

/// A semaphore to wait for or to signal. `value`: of a timeline semaphore; binary ones have none.
struct SemaphoreValue {
    VkSemaphore semaphore = VK_NULL_HANDLE;
    std::uint64_t value = 0;
};

/// A frame that was recorded or submitted; ascending from 1.
using Ticket = std::uint64_t;

/// What is known of a frame once it has run.
struct FrameReport {
    /// Of the picture, with this frame's. RenderSettings::samples: the picture is finished. 0: something overflowed, or what a
    /// truth was tracing has changed meanwhile.
    std::uint32_t samples = 0;
    /// What had no room in this frame, which therefore shows less than there is: one line each. The next frame has room.
    std::vector<std::string> overflows;
    std::vector<PassTime> passes;  ///< empty where the device has no timestamps
    LightTransport light{};        ///< that the frame has followed
    std::uint64_t covered = 0;     ///< pixels whose first surface is refracting glass; 0 where a truth traces the image
    std::array<std::uint64_t, kStatusCount> status{};  ///< covered pixels by Status
    std::uint64_t side_conflicts = 0;                  ///< as RenderResult::side_conflicts
    std::vector<std::string> warnings;  ///< what of the scene is drawn otherwise than it is; one line each
};

/// Objects of Vulkan that a renderer has made so far.
struct Made {
    std::uint64_t allocations = 0;  ///< of device memory
    std::uint64_t pipelines = 0;
    std::uint64_t pools = 0;  ///< of commands, descriptors and queries
};

/// Frames of a Renderer that run while the caller goes on. A renderer, which outlives them, has one such object at a time. Not
/// thread safe; used by the thread that uses the renderer. While a ticket has not been read, Renderer::render() and set_scene() throw Error; the other setters do not
/// wait, and hold for the frames after them.
///
/// RenderSettings::samples frames of equal settings, of a scene that does not change, make a picture together: each adds a
/// sample, and what its target gets is their mean, in the end that of Renderer::render(), bit for bit (of technique `path`: to
/// rounding). Frames after that show it again. With `samples` 1 every frame is a picture. AOVs, `error`, `paths` and the tone map kKrawczyk are of
/// stills: frames refuse them.
class PELLUCID_API Frames {
public:
    /// `in_flight`: tickets that may be unread at a time, 1 to 8. Throws Error if the renderer has Frames already.
    explicit Frames(Renderer& renderer, std::uint32_t in_flight = 2);
    /// Waits for frames that were submitted. Commands that were recorded must have run, or never will.
    ~Frames();
    Frames(const Frames&) = delete;
    Frames& operator=(const Frames&) = delete;

    /// Why the technique that they name cannot be recorded, in words that follow "cannot be recorded: "; empty: it can.
    std::string unrecordable(const RenderSettings& settings) const;

    /// Records a frame into `commands`, which are recording, outside of a render pass, for the renderer's queue family. Does
    /// not wait. The commands run once, in the order of the tickets; read() comes after they have, and lets go of what they
    /// use. Throws Error if the settings cannot be recorded, or if in_flight tickets are unread.
    Ticket record(VkCommandBuffer commands, const RenderSettings& settings, const Target& target,
                  const Background* background = nullptr);

    /// Draws a frame by submissions of its own, after `wait` and before `signal`. Takes every technique; does not wait: where
    /// the host has a part in the frame, a thread of the renderer's sees to it. Then binary semaphores are signalled by
    /// submissions that may come later; timeline semaphores may be waited for before. Throws Error for settings out of range,
    /// or if in_flight tickets are unread.
    Ticket submit(const RenderSettings& settings, const Target& target, std::span<const SemaphoreValue> wait = {},
                  std::span<const SemaphoreValue> signal = {}, const Background* background = nullptr);

    /// What became of a frame; nothing while it runs. Tickets are read in their order, each once. Throws DeviceError if
    /// the frame failed.
    std::optional<FrameReport> read(Ticket ticket);
    /// Waits for a frame that was submitted, then reads it.
    FrameReport wait(Ticket ticket);
    std::uint32_t unread() const;

    /// The next frame begins a new picture.
    void restart();

    /// What the renderer has made so far: steady frames make nothing.
    Made made() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid::vulkan
