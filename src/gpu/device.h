#pragma once

#include "gpu/device_features.h"
#include "gpu/vulkan.h"

#include <pellucid/device.h>
#include <pellucid/vulkan.h>

#include <cstdint>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pellucid {

/// Limits of a device's acceleration structures.
struct RayTracingLimits {
    std::uint32_t scratch_alignment;  ///< bytes, of the address of a build's scratch memory
    std::uint64_t max_triangles;      ///< in one acceleration structure
    std::uint64_t max_instances;
};

/// Data that is copied to a buffer at the beginning of the next frame; see upload_later() in gpu/memory.h.
struct PendingUpload {
    vk::Buffer buffer;
    std::uint64_t id;                  ///< ResourceId of the buffer
    std::shared_ptr<const void> held;  ///< Buffer::held()
    std::vector<std::byte> data;
    vk::DeviceSize offset;
};

/// The name of a lent device; empty if it has no instance or physical device.
std::string name_of(const vulkan::LentDevice& lent);

/// A Vulkan 1.3 device with one queue that does graphics and compute. Needs no surface.
class Device {
public:
    /// Throws DeviceError if no device fits, Error if `options.device` names none.
    explicit Device(const DeviceOptions& options);
    /// Wraps the caller's device. Throws DeviceError if it was created without features that Pellucid needs.
    explicit Device(const vulkan::LentDevice& lent);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const vk::raii::Device& handle() const { return device_; }
    /// Throws vk::DeviceLostError.
    void submit(const vk::SubmitInfo2& info, vk::Fence fence) const;
    std::uint32_t queue_family() const { return queue_family_; }
    const DeviceInfo& info() const { return info_; }
    const vk::PhysicalDeviceLimits& limits() const { return limits_; }

    /// Largest single allocation, and largest storage-buffer binding, in bytes.
    vk::DeviceSize max_allocation() const { return max_allocation_; }
    vk::DeviceSize max_storage_binding() const { return limits_.maxStorageBufferRange; }
    /// Atomics from fragment shaders, which the single-pass layer builder needs.
    bool fragment_atomics() const { return fragment_atomics_; }
    bool is_cpu() const { return is_cpu_; }  ///< a software driver
    /// Blending of RGBA32F targets, which dual depth peeling needs.
    bool float_blending() const { return float_blending_; }
    /// 64-bit integers in shaders and atomics on them in storage buffers, which light in volumes needs.
    bool long_atomics() const { return long_atomics_; }
    /// Limits of ray queries and acceleration structures; nullopt if the device has none.
    const std::optional<RayTracingLimits>& ray_tracing() const { return ray_tracing_; }
    /// Nanoseconds per timestamp tick; 0 if the queue has no timestamps.
    double timestamp_period_ns() const { return timestamp_period_ns_; }
    bool debug_labels() const { return debug_labels_; }

    /// A memory type in `type_bits` with all flags of `required` and, if possible, those of `preferred`.
    std::uint32_t memory_type(std::uint32_t type_bits, vk::MemoryPropertyFlags required,
                              vk::MemoryPropertyFlags preferred = {}) const;

    /// Vulkan objects created on this device so far.
    vulkan::Made& made() const { return *made_; }
    void add_upload(PendingUpload upload) const { uploads_->push_back(std::move(upload)); }
    /// Returns taken uploads. They go before uploads that were added since.
    void give_uploads_back(std::vector<PendingUpload> taken) const {
        uploads_->insert(uploads_->begin(), std::make_move_iterator(taken.begin()),
                         std::make_move_iterator(taken.end()));
    }
    std::vector<PendingUpload> take_uploads() const { return std::exchange(*uploads_, {}); }

    /// Messages of the validation layer so far, in order.
    const std::vector<std::string>& validation_messages() const { return *messages_; }

private:
    void describe_limits(const vk::raii::PhysicalDevice& physical);
    void create_device(const vk::raii::PhysicalDevice& physical);
    void use(const TurnedOn& features, const vk::raii::PhysicalDevice& physical);
    void borrow(const vulkan::LentDevice& lent);
    void give_back();

    vk::raii::Context context_;
    std::unique_ptr<std::vector<std::string>> messages_;  // the messenger has its address
    vk::raii::Instance instance_ = nullptr;
    vk::raii::DebugUtilsMessengerEXT messenger_ = nullptr;
    vk::raii::Device device_ = nullptr;
    vk::raii::Queue queue_ = nullptr;
    std::uint32_t queue_family_ = 0;
    std::mutex own_queue_mutex_;
    std::mutex* queue_mutex_ = &own_queue_mutex_;
    std::unique_ptr<vulkan::Made> made_ = std::make_unique<vulkan::Made>();
    std::unique_ptr<std::vector<PendingUpload>> uploads_ = std::make_unique<std::vector<PendingUpload>>();
    DeviceInfo info_;
    vk::PhysicalDeviceLimits limits_;
    vk::PhysicalDeviceMemoryProperties memory_;
    vk::DeviceSize max_allocation_ = 0;
    bool fragment_atomics_ = false;
    bool is_cpu_ = false;
    bool float_blending_ = false;
    bool long_atomics_ = false;
    std::optional<RayTracingLimits> ray_tracing_;
    bool debug_labels_ = false;
    double timestamp_period_ns_ = 0.0;
    bool lent_ = false;  ///< instance and device are the caller's
};

}  // namespace pellucid
