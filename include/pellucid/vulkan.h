#pragma once

// Pellucid on a Vulkan device of the caller's. This is the only public header with Vulkan types.
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

/// Features and extensions for creating a device: all that Pellucid requires, and the optional ones that the device
/// supports. A caller may enable more. Movable, not copyable.
class PELLUCID_API DeviceFeatures {
public:
    /// Throws DeviceError naming the missing features if Pellucid cannot use the device.
    DeviceFeatures(VkInstance instance, VkPhysicalDevice physical_device);
    ~DeviceFeatures();
    DeviceFeatures(DeviceFeatures&&) noexcept;
    DeviceFeatures& operator=(DeviceFeatures&&) noexcept;

    /// For VkDeviceCreateInfo::pNext: this structure and its chain, alive as long as this object.
    const VkPhysicalDeviceFeatures2* features() const;
    std::span<const char* const> extensions() const;
    /// A queue family with graphics and compute.
    std::uint32_t queue_family() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// A device of the caller's. Its Vulkan objects and mutex must outlive the Renderer, which destroys none of them.
///
/// Vulkan allows one thread at a time on a queue: the caller must not use `queue` while a function of the Renderer
/// runs. Pellucid waits for its own work on the queue before it returns, and for no other work.
struct LentDevice {
    VkInstance instance = VK_NULL_HANDLE;  ///< created for Vulkan 1.3 or later
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;  ///< with graphics and compute
    std::uint32_t queue_family = 0;  ///< family of `queue`
    /// Features and extensions that `device` was created with; read only in the constructor of the Renderer. Optional
    /// features (DeviceFeatures) that are off are not used; `absent` of Renderer::device() lists the fallbacks.
    const VkPhysicalDeviceFeatures2* features = nullptr;
    std::span<const char* const> extensions;
    /// If given, locked around every use of `queue`, because Frames::submit() uses a thread of its own. Other users of
    /// the queue must lock it too.
    std::mutex* queue_mutex = nullptr;
};

/// An image of the caller's that receives a frame: two-dimensional, one sample, usage TRANSFER_DST.
struct Target {
    VkImage image = VK_NULL_HANDLE;
    /// R8G8B8A8 or B8G8R8A8, UNORM or SRGB: RenderResult::display, with alpha 1. R32G32B32A32_SFLOAT:
    /// RenderResult::radiance, the mean of the samples so far.
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    VkOffset2D offset{0, 0};  ///< offset of the frame's first texel
    /// layout before the frame; UNDEFINED discards the image's content
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    VkImageLayout layout_after = VK_IMAGE_LAYOUT_GENERAL;
};

/// The caller's rendering of the same view, which Pellucid's scene is composed with. It occludes objects behind it.
/// Glass shows it by reflection and refraction where the image contains it (Wyman 2005). It casts no shadows on
/// Pellucid's objects and receives none. Both images have the frame's size and usage TRANSFER_SRC, and keep their
/// layouts.
struct Background {
    /// RGB, scene-linear radiance, in a format that can be blitted. Texels without geometry contain the caller's sky.
    VkImage color = VK_NULL_HANDLE;
    VkImageLayout color_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    VkImage depth = VK_NULL_HANDLE;  ///< D32_SFLOAT
    VkImageLayout depth_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    /// Rows z and w of the caller's projection, for z along the view axis in m, negative ahead: clip z = zz z + zw,
    /// clip w = wz z + ww. In a column-major matrix these are elements 10, 14, 11 and 15.
    float zz = 0.0f, zw = 0.0f, wz = -1.0f, ww = 0.0f;
    float far_depth = 1.0f;  ///< depth of texels without geometry: 1, or 0 if depth is reversed
};

/// A semaphore to wait for or to signal. `value`: for timeline semaphores; binary semaphores ignore it.
struct SemaphoreValue {
    VkSemaphore semaphore = VK_NULL_HANDLE;
    std::uint64_t value = 0;
};

/// Number of a recorded or submitted frame, ascending from 1.
using Ticket = std::uint64_t;

/// Results of a frame that has run.
struct FrameReport {
    /// Samples of the image, including this frame's. RenderSettings::samples: the image is complete. 0: a buffer
    /// overflowed, or the scene changed while a reference technique was tracing it.
    std::uint32_t samples = 0;
    /// Buffers whose capacity this frame exceeded, one line each; the frame is incomplete. The next frame has enough
    /// capacity.
    std::vector<std::string> overflows;
    std::vector<PassTime> passes;  ///< empty if the device has no timestamps
    LightTransport light{};        ///< light transport of the frame
    std::uint64_t covered = 0;     ///< pixels whose first surface is refracting glass; 0 for reference techniques
    std::array<std::uint64_t, kStatusCount> status{};  ///< covered pixels by Status
    std::uint64_t side_conflicts = 0;                  ///< as RenderResult::side_conflicts
    std::vector<std::string> warnings;                 ///< differences between the scene and its image; one line each
};

/// Vulkan objects that a renderer has created so far.
struct Made {
    std::uint64_t allocations = 0;  ///< allocations of device memory
    std::uint64_t pipelines = 0;
    std::uint64_t pools = 0;  ///< pools of commands, descriptors and queries
};

/// Asynchronous frames of a Renderer. The renderer must outlive this object and has one at a time. Not thread safe;
/// used on the same thread as the renderer. While a ticket is unread, Renderer::render() and set_scene() throw Error.
/// The other setters do not wait, and apply to later frames.
///
/// RenderSettings::samples frames of equal settings and an unchanged scene form one image. Each frame adds a sample,
/// and its target gets the mean so far. The last mean equals that of Renderer::render() bit for bit (for technique
/// `path` to within rounding). Further frames show it again. With `samples` 1 every frame is an image of its own.
/// Frames refuse AOVs, `error`, `paths` and the tone map kKrawczyk, which need stills.
class PELLUCID_API Frames {
public:
    /// `in_flight`: most unread tickets at a time, 1 to 8. Throws Error if the renderer already has Frames.
    explicit Frames(Renderer& renderer, std::uint32_t in_flight = 2);
    /// Waits for submitted frames. Recorded commands must have run, or must never run.
    ~Frames();
    Frames(const Frames&) = delete;
    Frames& operator=(const Frames&) = delete;

    /// Reason why the technique in `settings` cannot be recorded, worded to follow "cannot be recorded: "; empty: it
    /// can.
    std::string unrecordable(const RenderSettings& settings) const;

    /// Records a frame into `commands`. They must be in the recording state, outside of a render pass, for the
    /// renderer's queue family. Does not wait. The commands must run once, in the order of the tickets. Call read()
    /// after they have run; it releases the resources that they use. Throws Error if the settings cannot be recorded,
    /// or if in_flight tickets are unread.
    Ticket record(VkCommandBuffer commands, const RenderSettings& settings, const Target& target,
                  const Background* background = nullptr);

    /// Draws a frame by own submissions, after `wait` and before `signal`. Supports every technique and does not wait:
    /// a thread of the renderer's does the host's part of the frame. In that case binary semaphores are signalled by
    /// submissions that may come later; timeline semaphores may be waited for earlier. Throws Error for settings out
    /// of range, or if in_flight tickets are unread.
    Ticket submit(const RenderSettings& settings, const Target& target, std::span<const SemaphoreValue> wait = {},
                  std::span<const SemaphoreValue> signal = {}, const Background* background = nullptr);

    /// The report of a frame; empty while it runs. Read tickets in order, each once. Throws DeviceError if the frame
    /// failed.
    std::optional<FrameReport> read(Ticket ticket);
    /// Waits for a submitted frame, then reads it.
    FrameReport wait(Ticket ticket);
    std::uint32_t unread() const;

    /// Makes the next frame begin a new image.
    void restart();

    /// Counts of objects that the renderer has created. Steady frames create none.
    Made made() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid::vulkan
