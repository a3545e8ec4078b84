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

/// The device has no room for what is asked of it at once; for less it may.
class TooLarge : public Error {
public:
    using Error::Error;
};

/// Identifies a buffer or an image to the Recorder; never reused.
using ResourceId = std::uint64_t;

/// Device memory read and written by shaders. Throws Error if it is larger than the device allows.
class Buffer {
public:
    Buffer() = default;
    Buffer(Buffer&&) noexcept = default;
    Buffer& operator=(Buffer&&) noexcept = default;
    /// `texels`: the format in which shaders may also read it as a texel buffer.
    Buffer(const Device& device, std::string name, vk::DeviceSize size, vk::BufferUsageFlags usage,
           bool host_visible = false, vk::Format texels = vk::Format::eUndefined);

    vk::Buffer handle() const { return handles_ ? *handles_->buffer : vk::Buffer(); }
    vk::DeviceSize size() const { return size_; }
    ResourceId id() const { return id_; }
    const std::string& name() const { return name_; }
    /// Host address; null unless the buffer is host visible. Coherent.
    std::byte* mapped() const { return mapped_; }
    /// Device address; 0 unless `usage` has eShaderDeviceAddress, which needs Device::ray_tracing().
    vk::DeviceAddress address() const { return address_; }
    /// eUndefined: it is no texel buffer.
    vk::Format texels() const { return texels_; }
    vk::BufferView texel_view() const { return handles_ ? *handles_->texel_view : vk::BufferView(); }
    /// Whoever has it keeps the memory alive when the buffer goes.
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

/// A two-dimensional image, an array of them, or a three-dimensional image; one mip level. Always in layout GENERAL, so that a
/// pass needs only memory barriers (the cost on current desktop GPUs is small, and the software
/// driver has no layouts).
class GpuImage {
public:
    GpuImage() = default;
    GpuImage(GpuImage&&) noexcept = default;
    GpuImage& operator=(GpuImage&&) noexcept = default;
    GpuImage(const Device& device, std::string name, vk::Format format, vk::Extent2D extent, std::uint32_t layers,
             vk::ImageUsageFlags usage);
    /// Three-dimensional. Throws Error if it is larger than the device allows.
    GpuImage(const Device& device, std::string name, vk::Format format, vk::Extent3D extent, vk::ImageUsageFlags usage);

    vk::Image handle() const { return *handles_->image; }
    vk::ImageView array_view() const { return *handles_->array_view; }  ///< all layers, as a 2D array; or the 3D image
    vk::ImageView layer_view(std::uint32_t layer) const { return *handles_->layer_views.at(layer); }
    vk::Format format() const { return format_; }
    vk::Extent2D extent() const { return extent_; }
    std::uint32_t layers() const { return std::max<std::uint32_t>(1, std::uint32_t(handles_->layer_views.size())); }
    std::uint32_t depth() const { return depth_; }  ///< of a 3D image; 1 of others
    ResourceId id() const { return id_; }
    const std::string& name() const { return name_; }
    /// As Buffer::held().
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

/// Fills a device buffer (from byte `offset` on) or one layer of an image from host memory, and waits for it.
void upload(const Device& device, const Buffer& buffer, std::span<const std::byte> data, vk::DeviceSize offset = 0);
/// Fills whole words of a device buffer at the beginning of the next frame (Recorder::upload_pending()), after those before.
void upload_later(const Device& device, const Buffer& buffer, std::span<const std::byte> data,
                  vk::DeviceSize offset = 0);
void upload(const Device& device, const GpuImage& image, std::uint32_t layer, std::span<const std::byte> data);

/// Fills the box of a 3D image that begins at `first`, rows along x, then y, then z; and waits for it.
void upload_box(const Device& device, const GpuImage& image, vk::Offset3D first, vk::Extent3D extent,
                std::span<const std::byte> data);
/// The whole of a 3D image, after all submitted work.
std::vector<std::byte> download_box(const Device& device, const GpuImage& image);

/// Fills an RGBA32F image with `image`, RGB of the same size; alpha is 1.
void upload_rgb(const Device& device, const GpuImage& destination, const Image& image);

/// One layer of an image, tightly packed rows from the top, after all submitted work.
std::vector<std::byte> download(const Device& device, const GpuImage& image, std::uint32_t layer);

}  // namespace pellucid
