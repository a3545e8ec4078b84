#include "gpu/device.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>

namespace pellucid {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL collect_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                               const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    static_cast<std::vector<std::string>*>(user)->emplace_back(data->pMessage);
    return VK_FALSE;
}

std::string version_text(std::uint32_t version) {
    return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                       VK_API_VERSION_PATCH(version));
}

std::string type_name(vk::PhysicalDeviceType type) {
    switch (type) {
        case vk::PhysicalDeviceType::eDiscreteGpu:
            return "discrete";
        case vk::PhysicalDeviceType::eIntegratedGpu:
            return "integrated";
        case vk::PhysicalDeviceType::eVirtualGpu:
            return "virtual";
        case vk::PhysicalDeviceType::eCpu:
            return "software";
        default:
            return "other";
    }
}

int rank(std::string_view type) {
    constexpr std::array<std::string_view, 4> kBestFirst = {"discrete", "integrated", "virtual", "software"};
    return int(std::find(kBestFirst.begin(), kBestFirst.end(), type) - kBestFirst.begin());
}

RayTracingLimits ray_tracing_limits(const vk::raii::PhysicalDevice& physical) {
    const auto chain =
        physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceAccelerationStructurePropertiesKHR>();
    const auto& structure = chain.get<vk::PhysicalDeviceAccelerationStructurePropertiesKHR>();
    return {.scratch_alignment = structure.minAccelerationStructureScratchOffsetAlignment,
            .max_triangles = structure.maxPrimitiveCount,
            .max_instances = structure.maxInstanceCount};
}

std::vector<std::string> absent_features(const TurnedOn& features) {
    std::vector<std::string> absent;
    if (!features.fragment_atomics) absent.emplace_back("fragmentStoresAndAtomics: layers are built by depth peeling");
    if (!features.ray_tracing) absent.emplace_back("ray tracing: technique ray-tracing is not offered");
    return absent;
}

DeviceInfo describe(const vk::raii::PhysicalDevice& physical) {
    const vk::PhysicalDeviceProperties properties = physical.getProperties();
    DeviceInfo info;
    info.name = properties.deviceName.data();
    info.type = type_name(properties.deviceType);
    info.api_version = version_text(properties.apiVersion);
    info.missing = missing_features(physical);
    if (properties.apiVersion < VK_API_VERSION_1_3) return info;
    const auto chain = physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan12Properties>();
    const auto& driver = chain.get<vk::PhysicalDeviceVulkan12Properties>();
    info.driver = fmt::format("{} {}", driver.driverName.data(), driver.driverInfo.data());

    TurnedOn available;
    available.fragment_atomics = physical.getFeatures().fragmentStoresAndAtomics;
    available.ray_tracing = has_ray_tracing(physical);
    info.absent = absent_features(available);
    return info;
}

vk::raii::Instance make_instance(const vk::raii::Context& context, bool validation, bool& debug_utils) {
    std::vector<const char*> layers;
    std::vector<const char*> extensions;
    if (validation) {
        const auto available = context.enumerateInstanceLayerProperties();
        const bool found = std::any_of(available.begin(), available.end(), [](const vk::LayerProperties& layer) {
            return std::string_view(layer.layerName) == kValidationLayer;
        });
        if (!found) throw DeviceError(fmt::format("the validation layer {} is not installed", kValidationLayer));
        layers.push_back(kValidationLayer);
        extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    }
    const auto available = context.enumerateInstanceExtensionProperties();
    debug_utils = validation || std::any_of(available.begin(), available.end(), [](const vk::ExtensionProperties& e) {
                      return std::string_view(e.extensionName) == VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
                  });
    if (debug_utils) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);

    const std::array checks = {vk::ValidationFeatureEnableEXT::eSynchronizationValidation};
    const vk::ValidationFeaturesEXT features{.enabledValidationFeatureCount = checks.size(),
                                             .pEnabledValidationFeatures = checks.data()};
    const vk::ApplicationInfo application{.pApplicationName = "pellucid", .apiVersion = VK_API_VERSION_1_3};
    const vk::InstanceCreateInfo create{.pNext = validation ? &features : nullptr,
                                        .pApplicationInfo = &application,
                                        .enabledLayerCount = std::uint32_t(layers.size()),
                                        .ppEnabledLayerNames = layers.data(),
                                        .enabledExtensionCount = std::uint32_t(extensions.size()),
                                        .ppEnabledExtensionNames = extensions.data()};
    return vk::raii::Instance(context, create);
}

std::string lower(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return result;
}

std::size_t best_device(const std::vector<DeviceInfo>& infos) {
    std::optional<std::size_t> best;
    std::string why = "no Vulkan device found";
    for (std::size_t i = 0; i < infos.size(); ++i) {
        if (!infos[i].missing.empty()) {
            why = fmt::format("no usable Vulkan device: {} lacks {}", infos[i].name, fmt::join(infos[i].missing, ", "));
        } else if (!best || rank(infos[i].type) < rank(infos[*best].type)) {
            best = i;
        }
    }
    if (!best) throw DeviceError(why);
    return *best;
}

std::size_t named_device(const std::vector<DeviceInfo>& infos, const std::string& wanted) {
    std::size_t index = infos.size();
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    if (error != std::errc() || end != wanted.data() + wanted.size()) {
        const auto match = std::find_if(infos.begin(), infos.end(), [&](const DeviceInfo& info) {
            return lower(info.name).find(lower(wanted)) != std::string::npos;
        });
        index = std::size_t(match - infos.begin());
    }
    if (index >= infos.size()) {
        std::vector<std::string> known;
        for (std::size_t i = 0; i < infos.size(); ++i) known.push_back(fmt::format("{} ({})", i, infos[i].name));
        throw Error(fmt::format("unknown device '{}'; found: {}", wanted, fmt::join(known, ", ")));
    }
    if (!infos[index].missing.empty()) {
        throw DeviceError(fmt::format("{} lacks {}", infos[index].name, fmt::join(infos[index].missing, ", ")));
    }
    return index;
}

}  // namespace

std::vector<DeviceInfo> list_devices() {
    try {
        const vk::raii::Context context;
        bool debug_utils = false;
        const vk::raii::Instance instance = make_instance(context, false, debug_utils);
        std::vector<DeviceInfo> infos;
        for (const auto& physical : vk::raii::PhysicalDevices(instance)) infos.push_back(describe(physical));
        return infos;
    } catch (const vk::SystemError& error) {
        throw DeviceError(fmt::format("Vulkan is not usable: {}", error.what()));
    }
}

Device::Device(const DeviceOptions& options) : messages_(std::make_unique<std::vector<std::string>>()) {
    try {
        instance_ = make_instance(context_, options.validation, debug_labels_);
        if (options.validation) {
            using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
            using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
            messenger_ = instance_.createDebugUtilsMessengerEXT({
                .messageSeverity = Severity::eWarning | Severity::eError,
                .messageType = Type::eValidation | Type::ePerformance,
                .pfnUserCallback = &collect_message,
                .pUserData = messages_.get(),
            });
        }
        const vk::raii::PhysicalDevices physicals(instance_);
        std::vector<DeviceInfo> infos;
        for (const auto& physical : physicals) infos.push_back(describe(physical));
        const std::size_t chosen = options.device.empty() ? best_device(infos) : named_device(infos, options.device);
        info_ = infos[chosen];
        create_device(physicals[chosen]);
    } catch (const vk::SystemError& error) {
        throw DeviceError(fmt::format("Vulkan is not usable: {}", error.what()));
    }
}

std::string name_of(const vulkan::LentDevice& lent) {
    if (!lent.instance || !lent.physical_device) return {};
    const BorrowedPhysicalDevice borrowed(lent.instance, lent.physical_device);
    return borrowed.get().getProperties().deviceName.data();
}

Device::Device(const vulkan::LentDevice& lent) : messages_(std::make_unique<std::vector<std::string>>()) {
    const bool whole = lent.instance && lent.physical_device && lent.device && lent.queue && lent.features;
    if (!whole) throw DeviceError("a lent device needs instance, physical_device, device, queue and features");
    try {
        borrow(lent);
    } catch (const vk::SystemError& error) {
        give_back();
        throw DeviceError(fmt::format("Vulkan is not usable: {}", error.what()));
    } catch (...) {
        give_back();
        throw;
    }
}

Device::~Device() { give_back(); }

/// Releases the caller's handles without destroying them.
void Device::give_back() {
    if (!lent_) return;
    device_.release();
    instance_.release();
}

void Device::describe_limits(const vk::raii::PhysicalDevice& physical) {
    const auto chain = physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties>();
    limits_ = chain.get<vk::PhysicalDeviceProperties2>().properties.limits;
    max_allocation_ = chain.get<vk::PhysicalDeviceVulkan11Properties>().maxMemoryAllocationSize;
    memory_ = physical.getMemoryProperties();
    is_cpu_ = physical.getProperties().deviceType == vk::PhysicalDeviceType::eCpu;
    float_blending_ = bool(physical.getFormatProperties(vk::Format::eR32G32B32A32Sfloat).optimalTilingFeatures &
                           vk::FormatFeatureFlagBits::eColorAttachmentBlend);
    const std::uint32_t timestamp_bits = physical.getQueueFamilyProperties()[queue_family_].timestampValidBits;
    timestamp_period_ns_ = timestamp_bits > 0 ? double(limits_.timestampPeriod) : 0.0;
}

void Device::use(const TurnedOn& features, const vk::raii::PhysicalDevice& physical) {
    fragment_atomics_ = features.fragment_atomics;
    long_atomics_ = features.long_atomics;
    if (features.ray_tracing) ray_tracing_ = ray_tracing_limits(physical);
}

void Device::create_device(const vk::raii::PhysicalDevice& physical) {
    const vulkan::DeviceFeatures wanted(*instance_, *physical);
    queue_family_ = wanted.queue_family();
    describe_limits(physical);
    const float priority = 1.0f;
    const vk::DeviceQueueCreateInfo queue{
        .queueFamilyIndex = queue_family_, .queueCount = 1, .pQueuePriorities = &priority};
    device_ = physical.createDevice({.pNext = wanted.features(),
                                     .queueCreateInfoCount = 1,
                                     .pQueueCreateInfos = &queue,
                                     .enabledExtensionCount = std::uint32_t(wanted.extensions().size()),
                                     .ppEnabledExtensionNames = wanted.extensions().data()});
    queue_ = device_.getQueue(queue_family_, 0);
    use(turned_on(wanted.features(), wanted.extensions()), physical);
}

void Device::borrow(const vulkan::LentDevice& lent) {
    const TurnedOn features = turned_on(lent.features, lent.extensions);
    if (const auto missing = features.missing(); !missing.empty())
        throw DeviceError(fmt::format("the lent device was made without {}", fmt::join(missing, ", ")));
    instance_ = vk::raii::Instance(context_, lent.instance);
    lent_ = true;
    const vk::raii::PhysicalDevice physical(instance_, lent.physical_device);
    info_ = describe(physical);
    if (!info_.missing.empty())
        throw DeviceError(fmt::format("{} lacks {}", info_.name, fmt::join(info_.missing, ", ")));
    info_.absent = absent_features(features);
    device_ = vk::raii::Device(physical, lent.device);
    queue_ = vk::raii::Queue(device_, lent.queue);
    queue_family_ = lent.queue_family;
    if (lent.queue_mutex != nullptr) queue_mutex_ = lent.queue_mutex;
    describe_limits(physical);
    use(features, physical);
}

void Device::submit(const vk::SubmitInfo2& info, vk::Fence fence) const {
    const std::lock_guard lock(*queue_mutex_);
    queue_.submit2(info, fence);
}

std::uint32_t Device::memory_type(std::uint32_t type_bits, vk::MemoryPropertyFlags required,
                                  vk::MemoryPropertyFlags preferred) const {
    std::optional<std::uint32_t> fits;
    for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i) {
        const vk::MemoryPropertyFlags flags = memory_.memoryTypes[i].propertyFlags;
        if (!(type_bits & (1u << i)) || (flags & required) != required) continue;
        if ((flags & preferred) == preferred) return i;
        if (!fits) fits = i;
    }
    if (!fits) throw DeviceError(fmt::format("{} has no memory of the kind {}", info_.name, vk::to_string(required)));
    return *fits;
}

}  // namespace pellucid
