#pragma once

#include "gpu/vulkan.h"

#include <pellucid/vulkan.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace pellucid {

/// Families that do graphics and compute; nothing if there is none.
std::optional<std::uint32_t> universal_queue_family(const vk::raii::PhysicalDevice& physical);
/// Ray queries and acceleration structures.
bool has_ray_tracing(const vk::raii::PhysicalDevice& physical);
/// What Pellucid cannot do without and a device lacks, in Vulkan's words.
std::vector<std::string> missing_features(const vk::raii::PhysicalDevice& physical);

/// What a device was made with.
struct TurnedOn {
    bool dynamic_rendering = false, synchronization2 = false, maintenance4 = false;
    bool fragment_atomics = false;  ///< fragmentStoresAndAtomics
    bool long_atomics = false;      ///< 64-bit integers in shaders, and atomics on them in buffers
    bool ray_tracing = false;

    /// Those that Pellucid cannot do without, in Vulkan's words.
    std::vector<std::string> missing() const;
};
/// `features`: the chain that was given to vkCreateDevice.
TurnedOn turned_on(const VkPhysicalDeviceFeatures2* features, std::span<const char* const> extensions);

}  // namespace pellucid
