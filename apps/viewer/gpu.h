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

/// A Vulkan device for Pellucid that can present to windows.
class Gpu {
public:
    /// `device`: as DeviceOptions::device. `validation`: collect validation messages. Needs glfwInit(). Throws
    /// DeviceError.
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
    /// Lock it around every use of the queue.
    std::mutex& queue_mutex() { return queue_mutex_; }
    void wait_idle();
    /// Submits the commands recorded by `record`, and waits for them.
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
    vk::raii::DeviceMemory memory = nullptr;  // must outlive the image
    vk::raii::Image image = nullptr;
};

/// A buffer that the host can read and write.
struct HostBuffer {
    HostBuffer() = default;
    HostBuffer(const Gpu& gpu, vk::DeviceSize size, vk::BufferUsageFlags usage);

    vk::DeviceSize size = 0;
    vk::raii::DeviceMemory memory = nullptr;
    vk::raii::Buffer buffer = nullptr;
    void* mapped = nullptr;
};

/// Uploads `image` (RGB, 0..1) to a new image of format R8G8B8A8_UNORM in TRANSFER_SRC_OPTIMAL.
DeviceImage upload(Gpu& gpu, const Image& image);

/// Changes the layout of the whole image, with a barrier against all earlier and later commands.
void change_layout(const vk::raii::CommandBuffer& commands, vk::Image image, vk::ImageLayout from, vk::ImageLayout to);

/// Reads the first `extent` texels of an image of format R8G8B8A8_UNORM or B8G8R8A8_UNORM in TRANSFER_SRC_OPTIMAL:
/// RGB, 0..1.
Image read_texels(Gpu& gpu, vk::Image image, vk::Format format, vk::Extent2D extent);
/// Converts four bytes per texel to RGB, 0..1.
Image image_of(const void* texels, vk::Format format, vk::Extent2D extent);

}  // namespace pellucid::viewer
