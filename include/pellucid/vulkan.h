#pragma once

// Pellucid on a Vulkan device of the caller's. The only public header with Vulkan's types.
#include <pellucid/api.h>

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>
#include <span>

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
};

}  // namespace pellucid::vulkan
