#include "viewer/gpu.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace pellucid::viewer {
namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

/// Preference order of devices, as in DeviceOptions::device.
int rank(vk::PhysicalDeviceType type) {
    switch (type) {
        case vk::PhysicalDeviceType::eDiscreteGpu:
            return 0;
        case vk::PhysicalDeviceType::eIntegratedGpu:
            return 1;
        case vk::PhysicalDeviceType::eVirtualGpu:
            return 2;
        case vk::PhysicalDeviceType::eCpu:
            return 3;
        default:
            return 4;
    }
}

std::uint32_t memory_type(const Gpu& gpu, std::uint32_t allowed, vk::MemoryPropertyFlags wanted) {
    const vk::PhysicalDeviceMemoryProperties properties = gpu.physical().getMemoryProperties();
    for (std::uint32_t i = 0; i < properties.memoryTypeCount; ++i) {
        if ((allowed >> i & 1u) && (properties.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    }
    throw DeviceError("the device has no memory of the kind that the window needs");
}

}  // namespace

Gpu::Gpu(const std::string& device, bool validation) {
    try {
        make_instance(validation);
        choose_device(device);
        const float priority = 1.0f;
        const vk::DeviceQueueCreateInfo queue{
            .queueFamilyIndex = queue_family(), .queueCount = 1, .pQueuePriorities = &priority};
        const auto wanted = features_->extensions();
        extensions_.assign(wanted.begin(), wanted.end());
        extensions_.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
        device_ = physical_.createDevice({.pNext = features_->features(),
                                          .queueCreateInfoCount = 1,
                                          .pQueueCreateInfos = &queue,
                                          .enabledExtensionCount = std::uint32_t(extensions_.size()),
                                          .ppEnabledExtensionNames = extensions_.data()});
        queue_ = device_.getQueue(queue_family(), 0);
        pool_ = device_.createCommandPool(
            {.flags = vk::CommandPoolCreateFlagBits::eTransient, .queueFamilyIndex = queue_family()});
    } catch (const vk::SystemError& error) {
        throw DeviceError(fmt::format("Vulkan: {}", error.what()));
    }
}

void Gpu::make_instance(bool validation) {
    std::uint32_t count = 0;
    const char** needed = glfwGetRequiredInstanceExtensions(&count);
    if (needed == nullptr) throw DeviceError("Vulkan cannot show images in windows here");
    std::vector<const char*> extensions(needed, needed + count), layers;
    const std::array checks = {vk::ValidationFeatureEnableEXT::eSynchronizationValidation};
    const vk::ValidationFeaturesEXT features{.enabledValidationFeatureCount = checks.size(),
                                             .pEnabledValidationFeatures = checks.data()};
    if (validation) {
        layers.push_back("VK_LAYER_KHRONOS_validation");
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
        extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    }
    const vk::ApplicationInfo application{.pApplicationName = "pellucid-view", .apiVersion = VK_API_VERSION_1_3};
    instance_ = vk::raii::Instance(context_, {.pNext = validation ? &features : nullptr,
                                              .pApplicationInfo = &application,
                                              .enabledLayerCount = std::uint32_t(layers.size()),
                                              .ppEnabledLayerNames = layers.data(),
                                              .enabledExtensionCount = std::uint32_t(extensions.size()),
                                              .ppEnabledExtensionNames = extensions.data()});
    if (!validation) return;
    using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
    messenger_ =
        instance_.createDebugUtilsMessengerEXT({.messageSeverity = Severity::eWarning | Severity::eError,
                                                .messageType = vk::DebugUtilsMessageTypeFlagBitsEXT::eValidation,
                                                .pfnUserCallback = &note,
                                                .pUserData = this});
}

VkBool32 VKAPI_CALL Gpu::note(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                              const VkDebugUtilsMessengerCallbackDataEXT* data, void* gpu) {
    auto& self = *static_cast<Gpu*>(gpu);
    const std::scoped_lock lock(self.messages_mutex_);
    self.messages_.emplace_back(data->pMessage);
    return VK_FALSE;
}

void Gpu::choose_device(const std::string& wanted) {
    vk::raii::PhysicalDevices all(instance_);
    std::vector<std::size_t> order(all.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return rank(all[a].getProperties().deviceType) < rank(all[b].getProperties().deviceType);
    });
    std::string refused;
    for (const std::size_t i : order) {
        const std::string name = all[i].getProperties().deviceName;
        if (!wanted.empty() && wanted != std::to_string(i) && lower(name).find(lower(wanted)) == std::string::npos)
            continue;
        try {
            features_.emplace(*instance_, *all[i]);
        } catch (const DeviceError& error) {
            refused = error.what();
            continue;
        }
        if (glfwGetPhysicalDevicePresentationSupport(*instance_, *all[i], features_->queue_family())) {
            physical_ = std::move(all[i]);
            return;
        }
        refused = fmt::format("{} cannot show images in windows", name);
    }
    features_.reset();
    if (!refused.empty()) throw DeviceError(refused);
    throw DeviceError(wanted.empty() ? "no Vulkan device" : fmt::format("no Vulkan device '{}'", wanted));
}

vulkan::LentDevice Gpu::lent() {
    return {.instance = *instance_,
            .physical_device = *physical_,
            .device = *device_,
            .queue = *queue_,
            .queue_family = queue_family(),
            .features = features_->features(),
            .extensions = extensions_,
            .queue_mutex = &queue_mutex_};
}

bool Gpu::is_cpu() const { return physical_.getProperties().deviceType == vk::PhysicalDeviceType::eCpu; }

void Gpu::wait_idle() {
    const std::scoped_lock lock(queue_mutex_);
    device_.waitIdle();
}

vk::raii::CommandBuffer Gpu::begin() {
    vk::raii::CommandBuffers buffers(
        device_, {.commandPool = *pool_, .level = vk::CommandBufferLevel::ePrimary, .commandBufferCount = 1});
    buffers.front().begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    return std::move(buffers.front());
}

void Gpu::finish(const vk::raii::CommandBuffer& commands) {
    commands.end();
    const vk::raii::Fence fence(device_, vk::FenceCreateInfo{});
    {
        const std::scoped_lock lock(queue_mutex_);
        queue_.submit(vk::SubmitInfo{.commandBufferCount = 1, .pCommandBuffers = &*commands}, *fence);
    }
    if (device_.waitForFences(*fence, true, UINT64_MAX) != vk::Result::eSuccess)
        throw DeviceError("the device did not finish");
}

std::vector<std::string> Gpu::validation_messages() {
    const std::scoped_lock lock(messages_mutex_);
    return messages_;
}

DeviceImage::DeviceImage(const Gpu& gpu, vk::Extent2D size, vk::Format format, vk::ImageUsageFlags usage)
    : extent(size) {
    image = gpu.device().createImage({.imageType = vk::ImageType::e2D,
                                      .format = format,
                                      .extent = {size.width, size.height, 1},
                                      .mipLevels = 1,
                                      .arrayLayers = 1,
                                      .usage = usage});
    const vk::MemoryRequirements needs = image.getMemoryRequirements();
    memory = gpu.device().allocateMemory(
        {.allocationSize = needs.size,
         .memoryTypeIndex = memory_type(gpu, needs.memoryTypeBits, vk::MemoryPropertyFlagBits::eDeviceLocal)});
    image.bindMemory(*memory, 0);
}

HostBuffer::HostBuffer(const Gpu& gpu, vk::DeviceSize bytes, vk::BufferUsageFlags usage) : size(bytes) {
    buffer = gpu.device().createBuffer({.size = bytes, .usage = usage});
    const vk::MemoryRequirements needs = buffer.getMemoryRequirements();
    memory =
        gpu.device().allocateMemory({.allocationSize = needs.size,
                                     .memoryTypeIndex = memory_type(gpu, needs.memoryTypeBits,
                                                                    vk::MemoryPropertyFlagBits::eHostVisible |
                                                                        vk::MemoryPropertyFlagBits::eHostCoherent)});
    buffer.bindMemory(*memory, 0);
    mapped = memory.mapMemory(0, bytes);
}

void change_layout(const vk::raii::CommandBuffer& commands, vk::Image image, vk::ImageLayout from, vk::ImageLayout to) {
    constexpr auto kAll = vk::PipelineStageFlagBits2::eAllCommands;
    constexpr auto kAny = vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite;
    const vk::ImageMemoryBarrier2 barrier{.srcStageMask = kAll,
                                          .srcAccessMask = vk::AccessFlagBits2::eMemoryWrite,
                                          .dstStageMask = kAll,
                                          .dstAccessMask = kAny,
                                          .oldLayout = from,
                                          .newLayout = to,
                                          .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                          .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                          .image = image,
                                          .subresourceRange = {vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1}};
    commands.pipelineBarrier2({.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier});
}

DeviceImage upload(Gpu& gpu, const Image& from) {
    const vk::Extent2D extent{std::uint32_t(from.width), std::uint32_t(from.height)};
    using Layout = vk::ImageLayout;
    DeviceImage to(gpu, extent, vk::Format::eR8G8B8A8Unorm,
                   vk::ImageUsageFlagBits::eTransferDst | vk::ImageUsageFlagBits::eTransferSrc);
    const HostBuffer buffer(gpu, vk::DeviceSize(extent.width) * extent.height * 4,
                            vk::BufferUsageFlagBits::eTransferSrc);
    auto* bytes = static_cast<std::uint8_t*>(buffer.mapped);
    for (std::size_t i = 0; i < from.pixels.size() / 3; ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            bytes[4 * i + c] = std::uint8_t(std::clamp(from.pixels[3 * i + c], 0.0f, 1.0f) * 255.0f + 0.5f);
        bytes[4 * i + 3] = 255;
    }
    gpu.run([&](const vk::raii::CommandBuffer& commands) {
        const vk::BufferImageCopy copy{.imageSubresource = {vk::ImageAspectFlagBits::eColor, 0, 0, 1},
                                       .imageExtent = {extent.width, extent.height, 1}};
        change_layout(commands, *to.image, Layout::eUndefined, Layout::eTransferDstOptimal);
        commands.copyBufferToImage(*buffer.buffer, *to.image, Layout::eTransferDstOptimal, copy);
        change_layout(commands, *to.image, Layout::eTransferDstOptimal, Layout::eTransferSrcOptimal);
    });
    return to;
}

Image image_of(const void* texels, vk::Format format, vk::Extent2D extent) {
    Image image(int(extent.width), int(extent.height), 3);
    const auto* bytes = static_cast<const std::uint8_t*>(texels);
    const bool bgr = format == vk::Format::eB8G8R8A8Unorm;
    for (std::size_t i = 0; i < image.pixels.size() / 3; ++i) {
        for (std::size_t c = 0; c < 3; ++c) image.pixels[3 * i + c] = float(bytes[4 * i + (bgr ? 2 - c : c)]) / 255.0f;
    }
    return image;
}

Image read_texels(Gpu& gpu, vk::Image image, vk::Format format, vk::Extent2D extent) {
    const HostBuffer buffer(gpu, vk::DeviceSize(extent.width) * extent.height * 4,
                            vk::BufferUsageFlagBits::eTransferDst);
    gpu.run([&](const vk::raii::CommandBuffer& commands) {
        const vk::BufferImageCopy copy{.imageSubresource = {vk::ImageAspectFlagBits::eColor, 0, 0, 1},
                                       .imageExtent = {extent.width, extent.height, 1}};
        change_layout(commands, image, vk::ImageLayout::eTransferSrcOptimal, vk::ImageLayout::eTransferSrcOptimal);
        commands.copyImageToBuffer(image, vk::ImageLayout::eTransferSrcOptimal, *buffer.buffer, copy);
        const vk::MemoryBarrier2 barrier{.srcStageMask = vk::PipelineStageFlagBits2::eTransfer,
                                         .srcAccessMask = vk::AccessFlagBits2::eTransferWrite,
                                         .dstStageMask = vk::PipelineStageFlagBits2::eHost,
                                         .dstAccessMask = vk::AccessFlagBits2::eHostRead};
        commands.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &barrier});
    });
    return image_of(buffer.mapped, format, extent);
}

}  // namespace pellucid::viewer
