#pragma once

#include "viewer/vulkan_hpp.h"

#include <pellucid/pellucid.h>
#include <pellucid/vulkan.h>

#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace pellucid::viewer {

/// A Vulkan device that shows images in windows and that Pellucid draws on.
class Gpu {
public:
    /// `device`: as DeviceOptions::device. `validation`: messages are collected. Needs glfwInit(). Throws DeviceError.
    Gpu(const std::string& device, bool validation);
    Gpu(const Gpu&) = delete;
    Gpu& operator=(const Gpu&) = delete;

    vulkan::LentDevice lent();
    const vk::raii::Instance& instance() const { return instance_; }
    const vk::raii::PhysicalDevice& physical() const { return physical_; }
    const vk::raii::Device& device() const { return device_; }
    vk::Queue queue() const { return *queue_; }
    std::uint32_t queue_family() const { return features_->queue_family(); }
    bool is_cpu() const;
    /// To be locked around every use of the queue.
    std::mutex& queue_mutex() { return queue_mutex_; }
    void wait_idle();
    /// Submits commands that `record` records, and waits for them.
    template <class Record>
    void run(const Record& record) {
        const vk::raii::CommandBuffer commands = begin();
        record(commands);
        finish(commands);
    }
    std::vector<std::string> validation_messages();

private:
    void make_instance(bool validation);
    void choose_device(const std::string& device);
    vk::raii::CommandBuffer begin();
    void finish(const vk::raii::CommandBuffer& commands);
    static VkBool32 VKAPI_CALL note(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                    const VkDebugUtilsMessengerCallbackDataEXT* data, void* gpu);

    std::mutex messages_mutex_;
    std::vector<std::string> messages_;
    vk::raii::Context context_;
    vk::raii::Instance instance_ = nullptr;
    vk::raii::DebugUtilsMessengerEXT messenger_ = nullptr;
    vk::raii::PhysicalDevice physical_ = nullptr;
    std::optional<vulkan::DeviceFeatures> features_;
    std::vector<const char*> extensions_;
    vk::raii::Device device_ = nullptr;
    vk::raii::Queue queue_ = nullptr;
    std::mutex queue_mutex_;
    vk::raii::CommandPool pool_ = nullptr;
};

/// A two-dimensional image with memory of its own.
struct DeviceImage {
    DeviceImage() = default;
    DeviceImage(const Gpu& gpu, vk::Extent2D extent, vk::Format format, vk::ImageUsageFlags usage);

    vk::Extent2D extent;
    vk::raii::DeviceMemory memory = nullptr;  // outlives the image
    vk::raii::Image image = nullptr;
};

/// A buffer that the host reads and writes.
struct HostBuffer {
    HostBuffer() = default;
    HostBuffer(const Gpu& gpu, vk::DeviceSize size, vk::BufferUsageFlags usage);

    vk::DeviceSize size = 0;
    vk::raii::DeviceMemory memory = nullptr;
    vk::raii::Buffer buffer = nullptr;
    void* mapped = nullptr;
};

/// An image of format R8G8B8A8_UNORM in TRANSFER_SRC_OPTIMAL that holds `image`: RGB, 0..1.
DeviceImage upload(Gpu& gpu, const Image& image);

/// The whole image changes its layout, after everything before and before everything after.
void change_layout(const vk::raii::CommandBuffer& commands, vk::Image image, vk::ImageLayout from, vk::ImageLayout to);

/// The first texels of an image of format R8G8B8A8_UNORM or B8G8R8A8_UNORM that is in TRANSFER_SRC_OPTIMAL: RGB, 0..1.
Image read_texels(Gpu& gpu, vk::Image image, vk::Format format, vk::Extent2D extent);
/// RGB, 0..1, of four bytes a texel.
Image image_of(const void* texels, vk::Format format, vk::Extent2D extent);

}  // namespace pellucid::viewer
