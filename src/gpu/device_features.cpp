#include "gpu/device_features.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace pellucid {
namespace {

constexpr std::array<const char*, 3> kRayTracingExtensions = {
    VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME, VK_KHR_RAY_QUERY_EXTENSION_NAME,
    VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME,  // required by the first; unused otherwise
};

bool has_long_atomics(const vk::raii::PhysicalDevice& physical) {
    const auto chain = physical.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features>();
    return chain.get<vk::PhysicalDeviceFeatures2>().features.shaderInt64 &&
           chain.get<vk::PhysicalDeviceVulkan12Features>().shaderBufferInt64Atomics;
}

/// The structure of type `type` in a chain, or null.
template <class Structure>
const Structure* in_chain(const VkPhysicalDeviceFeatures2* features, VkStructureType type) {
    for (auto* each = reinterpret_cast<const VkBaseInStructure*>(features); each != nullptr; each = each->pNext)
        if (each->sType == type) return reinterpret_cast<const Structure*>(each);
    return nullptr;
}

bool all_in(std::span<const char* const> wanted, std::span<const char* const> names) {
    return std::all_of(wanted.begin(), wanted.end(), [&](std::string_view name) {
        return std::any_of(names.begin(), names.end(), [&](std::string_view each) { return each == name; });
    });
}

}  // namespace

std::optional<std::uint32_t> universal_queue_family(const vk::raii::PhysicalDevice& physical) {
    const auto families = physical.getQueueFamilyProperties();
    const auto wanted = vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eCompute;
    for (std::uint32_t i = 0; i < families.size(); ++i) {
        if ((families[i].queueFlags & wanted) == wanted) return i;
    }
    return std::nullopt;
}

bool has_ray_tracing(const vk::raii::PhysicalDevice& physical) {
    const auto available = physical.enumerateDeviceExtensionProperties();
    std::vector<const char*> names;
    for (const vk::ExtensionProperties& each : available) names.push_back(each.extensionName);
    if (!all_in(kRayTracingExtensions, names))
        return false;  // without the extensions, querying their features is not allowed
    const auto chain =
        physical
            .getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features,
                          vk::PhysicalDeviceAccelerationStructureFeaturesKHR, vk::PhysicalDeviceRayQueryFeaturesKHR>();
    return chain.get<vk::PhysicalDeviceVulkan12Features>().bufferDeviceAddress &&
           chain.get<vk::PhysicalDeviceAccelerationStructureFeaturesKHR>().accelerationStructure &&
           chain.get<vk::PhysicalDeviceRayQueryFeaturesKHR>().rayQuery;
}

std::vector<std::string> missing_features(const vk::raii::PhysicalDevice& physical) {
    if (physical.getProperties().apiVersion < VK_API_VERSION_1_3) return {"Vulkan 1.3"};
    const auto chain = physical.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan13Features>();
    const auto& features = chain.get<vk::PhysicalDeviceVulkan13Features>();
    TurnedOn available;
    available.dynamic_rendering = features.dynamicRendering;
    available.synchronization2 = features.synchronization2;
    available.maintenance4 = features.maintenance4;
    std::vector<std::string> missing = available.missing();
    if (!universal_queue_family(physical)) missing.emplace_back("a queue with graphics and compute");
    return missing;
}

std::vector<std::string> TurnedOn::missing() const {
    std::vector<std::string> names;
    if (!dynamic_rendering) names.emplace_back("dynamicRendering");
    if (!synchronization2) names.emplace_back("synchronization2");
    if (!maintenance4) names.emplace_back("maintenance4");
    return names;
}

TurnedOn turned_on(const VkPhysicalDeviceFeatures2* features, std::span<const char* const> extensions) {
    TurnedOn on;
    on.fragment_atomics = features->features.fragmentStoresAndAtomics;
    bool addresses = false, atomics = false;
    if (const auto* all =
            in_chain<VkPhysicalDeviceVulkan12Features>(features, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES))
        addresses = all->bufferDeviceAddress, atomics = all->shaderBufferInt64Atomics;
    if (const auto* one = in_chain<VkPhysicalDeviceBufferDeviceAddressFeatures>(
            features, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES))
        addresses = one->bufferDeviceAddress;
    if (const auto* one = in_chain<VkPhysicalDeviceShaderAtomicInt64Features>(
            features, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_INT64_FEATURES))
        atomics = one->shaderBufferInt64Atomics;
    on.long_atomics = features->features.shaderInt64 && atomics;
    if (const auto* all = in_chain<VkPhysicalDeviceVulkan13Features>(
            features, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES)) {
        on.dynamic_rendering = all->dynamicRendering;
        on.synchronization2 = all->synchronization2;
        on.maintenance4 = all->maintenance4;
    }
    if (const auto* one = in_chain<VkPhysicalDeviceDynamicRenderingFeatures>(
            features, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES))
        on.dynamic_rendering = one->dynamicRendering;
    if (const auto* one = in_chain<VkPhysicalDeviceSynchronization2Features>(
            features, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES))
        on.synchronization2 = one->synchronization2;
    if (const auto* one = in_chain<VkPhysicalDeviceMaintenance4Features>(
            features, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES))
        on.maintenance4 = one->maintenance4;
    const auto* structures = in_chain<VkPhysicalDeviceAccelerationStructureFeaturesKHR>(
        features, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR);
    const auto* queries = in_chain<VkPhysicalDeviceRayQueryFeaturesKHR>(
        features, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR);
    on.ray_tracing = addresses && structures && structures->accelerationStructure && queries && queries->rayQuery &&
                     all_in(kRayTracingExtensions, extensions);
    return on;
}

namespace vulkan {

struct DeviceFeatures::Impl {
    vk::PhysicalDeviceRayQueryFeaturesKHR queries{.rayQuery = true};
    vk::PhysicalDeviceAccelerationStructureFeaturesKHR structures{.pNext = &queries, .accelerationStructure = true};
    vk::PhysicalDeviceVulkan12Features features12;
    vk::PhysicalDeviceVulkan13Features features13{
        .pNext = &features12, .synchronization2 = true, .dynamicRendering = true, .maintenance4 = true};
    vk::PhysicalDeviceFeatures2 features{.pNext = &features13};
    std::span<const char* const> extensions;
    std::uint32_t queue_family = 0;
};

DeviceFeatures::DeviceFeatures(VkInstance instance, VkPhysicalDevice physical_device)
    : impl_(std::make_unique<Impl>()) {
    const BorrowedPhysicalDevice borrowed(instance, physical_device);
    const vk::raii::PhysicalDevice& physical = borrowed.get();
    if (const auto missing = missing_features(physical); !missing.empty())
        throw DeviceError(
            fmt::format("{} lacks {}", physical.getProperties().deviceName.data(), fmt::join(missing, ", ")));
    const bool traces = has_ray_tracing(physical), long_atomics = has_long_atomics(physical);
    impl_->features.features.fragmentStoresAndAtomics = physical.getFeatures().fragmentStoresAndAtomics;
    impl_->features.features.shaderInt64 = long_atomics;
    impl_->features12.shaderBufferInt64Atomics = long_atomics;
    impl_->features12.bufferDeviceAddress = traces;
    if (traces) impl_->features12.pNext = &impl_->structures;
    if (traces) impl_->extensions = kRayTracingExtensions;
    impl_->queue_family = *universal_queue_family(physical);
}
DeviceFeatures::~DeviceFeatures() = default;
DeviceFeatures::DeviceFeatures(DeviceFeatures&&) noexcept = default;
DeviceFeatures& DeviceFeatures::operator=(DeviceFeatures&&) noexcept = default;

const VkPhysicalDeviceFeatures2* DeviceFeatures::features() const {
    return &static_cast<const VkPhysicalDeviceFeatures2&>(impl_->features);
}
std::span<const char* const> DeviceFeatures::extensions() const { return impl_->extensions; }
std::uint32_t DeviceFeatures::queue_family() const { return impl_->queue_family; }

}  // namespace vulkan
}  // namespace pellucid
