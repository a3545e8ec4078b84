#pragma once

#include "gpu/device.h"

#include <pellucid/error.h>
#include <pellucid/image.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace pellucid {

/// A request exceeds the device's memory or limits. A smaller request may succeed.
class TooLarge : public Error {
public:
    using Error::Error;
};

/// Identifies a buffer or an image to the Recorder; never reused.
using ResourceId = std::uint64_t;

/// Device memory that shaders read and write. The constructor throws Error if `size` is larger than the device allows.
class Buffer {
public:
    Buffer() = default;
    Buffer(Buffer&&) noexcept = default;
    Buffer& operator=(Buffer&&) noexcept = default;
    /// `texels`: format in which shaders may also read the buffer as a texel buffer.
    Buffer(const Device& device, std::string name, vk::DeviceSize size, vk::BufferUsageFlags usage,
           bool host_visible = false, vk::Format texels = vk::Format::eUndefined);

    vk::Buffer handle() const { return handles_ ? *handles_->buffer : vk::Buffer(); }
    vk::DeviceSize size() const { return size_; }
    ResourceId id() const { return id_; }
    const std::string& name() const { return name_; }
    /// Host address of coherent memory; null unless the buffer is host visible.
    std::byte* mapped() const { return mapped_; }
    /// Device address; 0 unless `usage` has eShaderDeviceAddress, which needs Device::ray_tracing().
    vk::DeviceAddress address() const { return address_; }
    /// Format as a texel buffer; eUndefined if the buffer is none.
    vk::Format texels() const { return texels_; }
    vk::BufferView texel_view() const { return handles_ ? *handles_->texel_view : vk::BufferView(); }
    /// A handle that keeps the memory alive after the buffer is destroyed.
    std::shared_ptr<const void> held() const { return handles_; }

private:
    struct Handles {
        vk::raii::DeviceMemory memory = nullptr;  // outlives the others
        vk::raii::Buffer buffer = nullptr;
        vk::raii::BufferView texel_view = nullptr;
    };
    std::string name_;
    std::shared_ptr<Handles> handles_;
    vk::Format texels_ = vk::Format::eUndefined;
    vk::DeviceSize size_ = 0;
    ResourceId id_ = 0;
    std::byte* mapped_ = nullptr;
    vk::DeviceAddress address_ = 0;
};

/// A two-dimensional image, an array of them, or a three-dimensional image; one mip level. The layout is always
/// GENERAL, so a pass needs only memory barriers. The cost is small on current desktop GPUs, and the software driver
/// has no layouts.
class GpuImage {
public:
    GpuImage() = default;
    GpuImage(GpuImage&&) noexcept = default;
    GpuImage& operator=(GpuImage&&) noexcept = default;
    GpuImage(const Device& device, std::string name, vk::Format format, vk::Extent2D extent, std::uint32_t layers,
             vk::ImageUsageFlags usage);
    /// Creates a three-dimensional image. Throws Error if it is larger than the device allows.
    GpuImage(const Device& device, std::string name, vk::Format format, vk::Extent3D extent, vk::ImageUsageFlags usage);

    vk::Image handle() const { return *handles_->image; }
    vk::ImageView array_view() const { return *handles_->array_view; }  ///< all layers as a 2D array, or the 3D image
    vk::ImageView layer_view(std::uint32_t layer) const { return *handles_->layer_views.at(layer); }
    vk::Format format() const { return format_; }
    vk::Extent2D extent() const { return extent_; }
    std::uint32_t layers() const { return std::max<std::uint32_t>(1, std::uint32_t(handles_->layer_views.size())); }
    std::uint32_t depth() const { return depth_; }  ///< 1 unless the image is three-dimensional
    ResourceId id() const { return id_; }
    const std::string& name() const { return name_; }
    /// Like Buffer::held().
    std::shared_ptr<const void> held() const { return handles_; }

private:
    struct Handles {
        vk::raii::DeviceMemory memory = nullptr;  // outlives the others
        vk::raii::Image image = nullptr;
        vk::raii::ImageView array_view = nullptr;
        std::vector<vk::raii::ImageView> layer_views;
    };
    std::string name_;
    std::shared_ptr<Handles> handles_;
    vk::Format format_ = vk::Format::eUndefined;
    vk::Extent2D extent_;
    std::uint32_t depth_ = 1;
    ResourceId id_ = 0;
};

/// Bytes per texel of the formats Pellucid uses.
std::uint32_t texel_size(vk::Format format);

/// Copies host memory to a device buffer, from byte `offset` on, or to one layer of an image. Waits for the copy.
void upload(const Device& device, const Buffer& buffer, std::span<const std::byte> data, vk::DeviceSize offset = 0);
/// Copies whole words to a device buffer at the beginning of the next frame (Recorder::upload_pending()), in the order
/// of the calls.
void upload_later(const Device& device, const Buffer& buffer, std::span<const std::byte> data,
                  vk::DeviceSize offset = 0);
void upload(const Device& device, const GpuImage& image, std::uint32_t layer, std::span<const std::byte> data);

/// Fills the box of a 3D image that begins at `first`, and waits. `data`: rows along x, then y, then z.
void upload_box(const Device& device, const GpuImage& image, vk::Offset3D first, vk::Extent3D extent,
                std::span<const std::byte> data);
/// Downloads a whole 3D image after all submitted work.
std::vector<std::byte> download_box(const Device& device, const GpuImage& image);

/// Fills an RGBA32F image from an RGB image of the same size; alpha is 1.
void upload_rgb(const Device& device, const GpuImage& destination, const Image& image);

/// Downloads one layer of an image after all submitted work, as tightly packed rows from the top.
std::vector<std::byte> download(const Device& device, const GpuImage& image, std::uint32_t layer);

}  // namespace pellucid
