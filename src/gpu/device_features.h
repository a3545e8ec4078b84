#pragma once

#include "gpu/vulkan.h"

#include <pellucid/vulkan.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace pellucid {

/// A device of the caller's instance, which stays the caller's. The instance's function table lives as long as this.
class BorrowedPhysicalDevice {
public:
    BorrowedPhysicalDevice(VkInstance instance, VkPhysicalDevice physical_device)
        : instance_(context_, instance), physical_(instance_, physical_device) {}
    ~BorrowedPhysicalDevice() { instance_.release(); }
    BorrowedPhysicalDevice(const BorrowedPhysicalDevice&) = delete;
    BorrowedPhysicalDevice& operator=(const BorrowedPhysicalDevice&) = delete;

    const vk::raii::PhysicalDevice& get() const { return physical_; }

private:
    vk::raii::Context context_;
    vk::raii::Instance instance_;
    vk::raii::PhysicalDevice physical_;
};

/// The first queue family with graphics and compute, if any.
std::optional<std::uint32_t> universal_queue_family(const vk::raii::PhysicalDevice& physical);
/// Whether the device has ray queries and acceleration structures.
bool has_ray_tracing(const vk::raii::PhysicalDevice& physical);
/// Vulkan names of the features that Pellucid requires and the device lacks.
std::vector<std::string> missing_features(const vk::raii::PhysicalDevice& physical);

/// The features with which a device was created.
struct TurnedOn {
    bool dynamic_rendering = false, synchronization2 = false, maintenance4 = false;
    bool fragment_atomics = false;  ///< fragmentStoresAndAtomics
    bool long_atomics = false;      ///< 64-bit integers in shaders, and atomics on them in buffers
    bool ray_tracing = false;

    /// Vulkan names of the required features that are off.
    std::vector<std::string> missing() const;
};
/// `features`, `extensions`: as given to vkCreateDevice.
TurnedOn turned_on(const VkPhysicalDeviceFeatures2* features, std::span<const char* const> extensions);

}  // namespace pellucid
