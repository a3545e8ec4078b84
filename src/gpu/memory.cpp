#include "gpu/memory.h"

#include "core/math.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <functional>

namespace pellucid {
namespace {

constexpr vk::DeviceSize kStagingSize = 64u << 20;

ResourceId next_resource_id() {
    static std::atomic<ResourceId> last{0};
    return ++last;
}

vk::raii::DeviceMemory allocate(const Device& device, const std::string& name, const vk::MemoryRequirements& needs,
                                vk::MemoryPropertyFlags required, vk::MemoryPropertyFlags preferred,
                                vk::MemoryAllocateFlags flags = {}) {
    if (needs.size > device.max_allocation()) {
        throw TooLarge(fmt::format("{} needs {:.2f} GiB, more than the {:.2f} GiB that {} allocates at once", name,
                                   double(needs.size) / double(1u << 30),
                                   double(device.max_allocation()) / double(1u << 30), device.info().name));
    }
    const vk::MemoryAllocateFlagsInfo flags_info{.flags = flags};
    ++device.made().allocations;
    try {
        return device.handle().allocateMemory(
            {.pNext = flags ? &flags_info : nullptr,
             .allocationSize = needs.size,
             .memoryTypeIndex = device.memory_type(needs.memoryTypeBits, required, preferred)});
    } catch (const vk::OutOfDeviceMemoryError&) {
        throw TooLarge(fmt::format("{}: out of device memory for {:.1f} MiB; give a smaller size or a smaller scene",
                                   name, double(needs.size) / double(1u << 20)));
    }
}

/// Records, submits and waits. Use it only for uploads and downloads; frames use the Recorder.
void submit_once(const Device& device, const std::function<void(const vk::raii::CommandBuffer&)>& record) {
    const auto& handle = device.handle();
    ++device.made().pools;
    const vk::raii::CommandPool pool = handle.createCommandPool(
        {.flags = vk::CommandPoolCreateFlagBits::eTransient, .queueFamilyIndex = device.queue_family()});
    const auto commands = handle.allocateCommandBuffers({.commandPool = *pool, .commandBufferCount = 1});
    commands[0].begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    record(commands[0]);
    commands[0].end();
    const vk::raii::Fence fence = handle.createFence({});
    const vk::CommandBufferSubmitInfo command{.commandBuffer = *commands[0]};
    device.submit({.commandBufferInfoCount = 1, .pCommandBufferInfos = &command}, *fence);
    while (handle.waitForFences(*fence, true, ~0ull) == vk::Result::eTimeout) {
    }
}

Buffer staging_buffer(const Device& device, vk::DeviceSize size) {
    return Buffer(device, "staging", size,
                  vk::BufferUsageFlagBits::eTransferSrc | vk::BufferUsageFlagBits::eTransferDst, true);
}

vk::ImageAspectFlags aspect_of(vk::Format format) {
    return format == vk::Format::eD32Sfloat ? vk::ImageAspectFlagBits::eDepth : vk::ImageAspectFlagBits::eColor;
}

void change_layout(const vk::raii::CommandBuffer& commands, const GpuImage& image, vk::ImageLayout from,
                   vk::ImageLayout to) {
    const auto everything = vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite;
    const vk::ImageMemoryBarrier2 barrier{
        .srcStageMask = vk::PipelineStageFlagBits2::eAllCommands,
        .srcAccessMask = everything,
        .dstStageMask = vk::PipelineStageFlagBits2::eAllCommands,
        .dstAccessMask = everything,
        .oldLayout = from,
        .newLayout = to,
        .image = image.handle(),
        .subresourceRange = {.aspectMask = aspect_of(image.format()), .levelCount = 1, .layerCount = image.layers()}};
    commands.pipelineBarrier2({.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier});
}

vk::BufferImageCopy2 copy_region(const GpuImage& image, std::uint32_t layer, std::uint32_t row, std::uint32_t rows) {
    return {.imageSubresource = {.aspectMask = vk::ImageAspectFlagBits::eColor,
                                 .mipLevel = 0,
                                 .baseArrayLayer = layer,
                                 .layerCount = 1},
            .imageOffset = {0, std::int32_t(row), 0},
            .imageExtent = {image.extent().width, rows, 1}};
}

/// Calls `copy(first_row, row_count)` for bands of rows that fit into the staging buffer.
void for_each_band(const GpuImage& image, const std::function<void(std::uint32_t, std::uint32_t)>& copy) {
    const vk::DeviceSize row_bytes = vk::DeviceSize(image.extent().width) * texel_size(image.format());
    const auto band = std::uint32_t(std::max<vk::DeviceSize>(1, kStagingSize / row_bytes));
    for (std::uint32_t row = 0; row < image.extent().height; row += band) {
        copy(row, std::min(band, image.extent().height - row));
    }
}

}  // namespace

std::uint32_t texel_size(vk::Format format) {
    switch (format) {
        case vk::Format::eR8G8B8A8Unorm:
        case vk::Format::eR32Sfloat:
        case vk::Format::eR32Uint:
        case vk::Format::eD32Sfloat:
            return 4;
        case vk::Format::eR32G32Uint:
        case vk::Format::eR32G32Sfloat:
        case vk::Format::eR16G16B16A16Sfloat:
            return 8;
        case vk::Format::eR32G32B32A32Sfloat:
        case vk::Format::eR32G32B32A32Uint:
            return 16;
        default:
            throw std::logic_error("texel_size: unexpected format " + vk::to_string(format));
    }
}

Buffer::Buffer(const Device& device, std::string name, vk::DeviceSize size, vk::BufferUsageFlags usage,
               bool host_visible, vk::Format texels)
    : name_(std::move(name)), texels_(texels), size_(std::max<vk::DeviceSize>(size, 4)), id_(next_resource_id()) {
    if (texels != vk::Format::eUndefined) {
        const vk::DeviceSize most = vk::DeviceSize(device.limits().maxTexelBufferElements) * texel_size(texels);
        if (size_ > most) {
            throw TooLarge(fmt::format("{} needs {} MiB in one texel buffer; {} allows {} MiB", name_, size_ >> 20,
                                       device.info().name, most >> 20));
        }
        size_ = std::max<vk::DeviceSize>(size_, texel_size(texels));
        usage |= vk::BufferUsageFlagBits::eUniformTexelBuffer;
    }
    const bool addressed = bool(usage & vk::BufferUsageFlagBits::eShaderDeviceAddress);  // such a buffer is not bound
    if ((usage & vk::BufferUsageFlagBits::eStorageBuffer) && !addressed && size_ > device.max_storage_binding()) {
        throw TooLarge(fmt::format("{} needs {} MiB in one storage buffer; {} allows {} MiB", name_, size_ >> 20,
                                   device.info().name, device.max_storage_binding() >> 20));
    }
    handles_ = std::make_shared<Handles>();
    handles_->buffer = device.handle().createBuffer({.size = size_, .usage = usage});
    using Property = vk::MemoryPropertyFlagBits;
    const vk::MemoryPropertyFlags required =
        host_visible ? Property::eHostVisible | Property::eHostCoherent : vk::MemoryPropertyFlags{};
    const vk::MemoryPropertyFlags preferred = host_visible ? required | Property::eHostCached : Property::eDeviceLocal;
    handles_->memory = allocate(device, name_, handles_->buffer.getMemoryRequirements(), required, preferred,
                                addressed ? vk::MemoryAllocateFlagBits::eDeviceAddress : vk::MemoryAllocateFlags{});
    handles_->buffer.bindMemory(*handles_->memory, 0);
    if (texels != vk::Format::eUndefined) {
        handles_->texel_view =
            device.handle().createBufferView({.buffer = *handles_->buffer, .format = texels, .range = VK_WHOLE_SIZE});
    }
    if (addressed) address_ = device.handle().getBufferAddress({.buffer = *handles_->buffer});
    if (host_visible) mapped_ = static_cast<std::byte*>(handles_->memory.mapMemory(0, VK_WHOLE_SIZE));
}

GpuImage::GpuImage(const Device& device, std::string name, vk::Format format, vk::Extent2D extent, std::uint32_t layers,
                   vk::ImageUsageFlags usage)
    : name_(std::move(name)), format_(format), extent_(extent), id_(next_resource_id()) {
    const std::uint32_t limit = device.limits().maxImageDimension2D;
    if (extent.width == 0 || extent.height == 0 || extent.width > limit || extent.height > limit) {
        throw TooLarge(fmt::format("{} of {}x{}: {} allows 1x1 to {}x{}", name_, extent.width, extent.height,
                                   device.info().name, limit, limit));
    }
    if (layers == 0 || layers > device.limits().maxImageArrayLayers) {
        throw Error(fmt::format("{} with {} layers: {} allows 1 to {}", name_, layers, device.info().name,
                                device.limits().maxImageArrayLayers));
    }
    const vk::DeviceSize bytes = vk::DeviceSize(extent.width) * extent.height * layers * texel_size(format);
    if (bytes > device.max_allocation()) {
        throw TooLarge(fmt::format("{} of {}x{} with {} layer(s) needs {:.2f} GiB; {} allocates {:.2f} GiB at once",
                                   name_, extent.width, extent.height, layers, double(bytes) / double(1u << 30),
                                   device.info().name, double(device.max_allocation()) / double(1u << 30)));
    }
    handles_ = std::make_shared<Handles>();
    handles_->image = device.handle().createImage({.imageType = vk::ImageType::e2D,
                                                   .format = format,
                                                   .extent = {extent.width, extent.height, 1},
                                                   .mipLevels = 1,
                                                   .arrayLayers = layers,
                                                   .samples = vk::SampleCountFlagBits::e1,
                                                   .tiling = vk::ImageTiling::eOptimal,
                                                   .usage = usage,
                                                   .initialLayout = vk::ImageLayout::eUndefined});
    handles_->memory =
        allocate(device, name_, handles_->image.getMemoryRequirements(), {}, vk::MemoryPropertyFlagBits::eDeviceLocal);
    handles_->image.bindMemory(*handles_->memory, 0);

    const auto view = [&](vk::ImageViewType type, std::uint32_t first, std::uint32_t count) {
        return device.handle().createImageView(
            {.image = *handles_->image,
             .viewType = type,
             .format = format,
             .subresourceRange = {
                 .aspectMask = aspect_of(format), .levelCount = 1, .baseArrayLayer = first, .layerCount = count}});
    };
    handles_->array_view = view(vk::ImageViewType::e2DArray, 0, layers);
    for (std::uint32_t layer = 0; layer < layers; ++layer) {
        handles_->layer_views.push_back(view(vk::ImageViewType::e2D, layer, 1));
    }
    submit_once(device, [&](const vk::raii::CommandBuffer& commands) {
        change_layout(commands, *this, vk::ImageLayout::eUndefined, vk::ImageLayout::eGeneral);
    });
}

GpuImage::GpuImage(const Device& device, std::string name, vk::Format format, vk::Extent3D extent,
                   vk::ImageUsageFlags usage)
    : name_(std::move(name)), format_(format), extent_{extent.width, extent.height}, depth_(extent.depth),
      id_(next_resource_id()) {
    const std::uint32_t limit = device.limits().maxImageDimension3D;
    const std::uint32_t largest = std::max({extent.width, extent.height, extent.depth});
    if (std::min({extent.width, extent.height, extent.depth}) == 0 || largest > limit) {
        throw Error(fmt::format("{} of {}x{}x{}: {} allows 1 to {} along every axis", name_, extent.width,
                                extent.height, extent.depth, device.info().name, limit));
    }
    const double bytes = double(extent.width) * extent.height * extent.depth * texel_size(format);
    if (bytes > double(device.max_allocation())) {
        throw Error(fmt::format("{} of {}x{}x{} needs {:.2f} GiB; {} allocates {:.2f} GiB at once", name_, extent.width,
                                extent.height, extent.depth, bytes / double(1u << 30), device.info().name,
                                double(device.max_allocation()) / double(1u << 30)));
    }
    handles_ = std::make_shared<Handles>();
    handles_->image = device.handle().createImage({.imageType = vk::ImageType::e3D,
                                                   .format = format,
                                                   .extent = extent,
                                                   .mipLevels = 1,
                                                   .arrayLayers = 1,
                                                   .samples = vk::SampleCountFlagBits::e1,
                                                   .tiling = vk::ImageTiling::eOptimal,
                                                   .usage = usage,
                                                   .initialLayout = vk::ImageLayout::eUndefined});
    handles_->memory =
        allocate(device, name_, handles_->image.getMemoryRequirements(), {}, vk::MemoryPropertyFlagBits::eDeviceLocal);
    handles_->image.bindMemory(*handles_->memory, 0);
    handles_->array_view = device.handle().createImageView(
        {.image = *handles_->image,
         .viewType = vk::ImageViewType::e3D,
         .format = format,
         .subresourceRange = {.aspectMask = aspect_of(format), .levelCount = 1, .layerCount = 1}});
    submit_once(device, [&](const vk::raii::CommandBuffer& commands) {
        change_layout(commands, *this, vk::ImageLayout::eUndefined, vk::ImageLayout::eGeneral);
    });
}

void upload(const Device& device, const Buffer& buffer, std::span<const std::byte> data, vk::DeviceSize offset) {
    if (data.empty()) return;
    const Buffer staging = staging_buffer(device, std::min<vk::DeviceSize>(kStagingSize, data.size()));
    for (vk::DeviceSize done = 0; done < data.size(); done += staging.size()) {
        const vk::DeviceSize bytes = std::min<vk::DeviceSize>(staging.size(), data.size() - done);
        std::memcpy(staging.mapped(), data.data() + done, bytes);
        submit_once(device, [&](const vk::raii::CommandBuffer& commands) {
            commands.copyBuffer(staging.handle(), buffer.handle(),
                                vk::BufferCopy{.dstOffset = offset + done, .size = bytes});
        });
    }
}

void upload_later(const Device& device, const Buffer& buffer, std::span<const std::byte> data, vk::DeviceSize offset) {
    if (data.empty()) return;
    device.add_upload({buffer.handle(), buffer.id(), buffer.held(), {data.begin(), data.end()}, offset});
}

void upload(const Device& device, const GpuImage& image, std::uint32_t layer, std::span<const std::byte> data) {
    const std::size_t row_bytes = std::size_t(image.extent().width) * texel_size(image.format());
    const Buffer staging =
        staging_buffer(device, std::max<vk::DeviceSize>(row_bytes, std::min(kStagingSize, data.size())));
    for_each_band(image, [&](std::uint32_t row, std::uint32_t rows) {
        std::memcpy(staging.mapped(), data.data() + row * row_bytes, rows * row_bytes);
        submit_once(device, [&](const vk::raii::CommandBuffer& commands) {
            const vk::BufferImageCopy2 region = copy_region(image, layer, row, rows);
            change_layout(commands, image, vk::ImageLayout::eGeneral, vk::ImageLayout::eTransferDstOptimal);
            commands.copyBufferToImage2({.srcBuffer = staging.handle(),
                                         .dstImage = image.handle(),
                                         .dstImageLayout = vk::ImageLayout::eTransferDstOptimal,
                                         .regionCount = 1,
                                         .pRegions = &region});
            change_layout(commands, image, vk::ImageLayout::eTransferDstOptimal, vk::ImageLayout::eGeneral);
        });
    });
}

namespace {

/// Calls `copy(region, bytes, offset)` for slabs of a box of a 3D image. A slab has as many slices as fit into the
/// staging buffer, and at least one.
void for_each_slab(const GpuImage& image, vk::Offset3D first, vk::Extent3D extent,
                   const std::function<void(const vk::BufferImageCopy2&, vk::DeviceSize, vk::DeviceSize)>& copy) {
    const vk::DeviceSize slice = vk::DeviceSize(extent.width) * extent.height * texel_size(image.format());
    const auto slab = std::uint32_t(std::max<vk::DeviceSize>(1, kStagingSize / slice));
    for (std::uint32_t z = 0; z < extent.depth; z += slab) {
        const std::uint32_t slices = std::min(slab, extent.depth - z);
        copy({.imageSubresource = {.aspectMask = vk::ImageAspectFlagBits::eColor, .layerCount = 1},
              .imageOffset = {first.x, first.y, first.z + std::int32_t(z)},
              .imageExtent = {extent.width, extent.height, slices}},
             slices * slice, z * slice);
    }
}

vk::DeviceSize slab_size(const GpuImage& image, vk::Extent3D extent) {
    const vk::DeviceSize slice = vk::DeviceSize(extent.width) * extent.height * texel_size(image.format());
    return slice * std::min<vk::DeviceSize>(extent.depth, std::max<vk::DeviceSize>(1, kStagingSize / slice));
}

}  // namespace

void upload_box(const Device& device, const GpuImage& image, vk::Offset3D first, vk::Extent3D extent,
                std::span<const std::byte> data) {
    const Buffer staging = staging_buffer(device, slab_size(image, extent));
    for_each_slab(image, first, extent,
                  [&](const vk::BufferImageCopy2& region, vk::DeviceSize bytes, vk::DeviceSize offset) {
                      std::memcpy(staging.mapped(), data.data() + offset, bytes);
                      submit_once(device, [&](const vk::raii::CommandBuffer& commands) {
                          const auto general = vk::ImageLayout::eGeneral, target = vk::ImageLayout::eTransferDstOptimal;
                          change_layout(commands, image, general, target);
                          commands.copyBufferToImage2({.srcBuffer = staging.handle(),
                                                       .dstImage = image.handle(),
                                                       .dstImageLayout = target,
                                                       .regionCount = 1,
                                                       .pRegions = &region});
                          change_layout(commands, image, target, general);
                      });
                  });
}

std::vector<std::byte> download_box(const Device& device, const GpuImage& image) {
    const vk::Extent3D extent{image.extent().width, image.extent().height, image.depth()};
    std::vector<std::byte> data(std::size_t(extent.width) * extent.height * extent.depth * texel_size(image.format()));
    const Buffer staging = staging_buffer(device, slab_size(image, extent));
    for_each_slab(image, {}, extent,
                  [&](const vk::BufferImageCopy2& region, vk::DeviceSize bytes, vk::DeviceSize offset) {
                      submit_once(device, [&](const vk::raii::CommandBuffer& commands) {
                          const auto general = vk::ImageLayout::eGeneral, source = vk::ImageLayout::eTransferSrcOptimal;
                          change_layout(commands, image, general, source);
                          commands.copyImageToBuffer2({.srcImage = image.handle(),
                                                       .srcImageLayout = source,
                                                       .dstBuffer = staging.handle(),
                                                       .regionCount = 1,
                                                       .pRegions = &region});
                          change_layout(commands, image, source, general);
                          const vk::MemoryBarrier2 to_host{.srcStageMask = vk::PipelineStageFlagBits2::eCopy,
                                                           .srcAccessMask = vk::AccessFlagBits2::eTransferWrite,
                                                           .dstStageMask = vk::PipelineStageFlagBits2::eHost,
                                                           .dstAccessMask = vk::AccessFlagBits2::eHostRead};
                          commands.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &to_host});
                      });
                      std::memcpy(data.data() + offset, staging.mapped(), bytes);
                  });
    return data;
}

void upload_rgb(const Device& device, const GpuImage& destination, const Image& image) {
    std::vector<glm::vec4> texels(std::size_t(image.width) * std::size_t(image.height));
    for (std::size_t i = 0; i < texels.size(); ++i) {
        texels[i] = glm::vec4(image.pixels[3 * i], image.pixels[3 * i + 1], image.pixels[3 * i + 2], 1.0f);
    }
    upload(device, destination, 0, std::as_bytes(std::span(texels)));
}

std::vector<std::byte> download(const Device& device, const GpuImage& image, std::uint32_t layer) {
    const std::size_t row_bytes = std::size_t(image.extent().width) * texel_size(image.format());
    std::vector<std::byte> data(row_bytes * image.extent().height);
    const Buffer staging =
        staging_buffer(device, std::max<vk::DeviceSize>(row_bytes, std::min(kStagingSize, data.size())));
    for_each_band(image, [&](std::uint32_t row, std::uint32_t rows) {
        submit_once(device, [&](const vk::raii::CommandBuffer& commands) {
            const vk::BufferImageCopy2 region = copy_region(image, layer, row, rows);
            change_layout(commands, image, vk::ImageLayout::eGeneral, vk::ImageLayout::eTransferSrcOptimal);
            commands.copyImageToBuffer2({.srcImage = image.handle(),
                                         .srcImageLayout = vk::ImageLayout::eTransferSrcOptimal,
                                         .dstBuffer = staging.handle(),
                                         .regionCount = 1,
                                         .pRegions = &region});
            change_layout(commands, image, vk::ImageLayout::eTransferSrcOptimal, vk::ImageLayout::eGeneral);
            const vk::MemoryBarrier2 to_host{.srcStageMask = vk::PipelineStageFlagBits2::eCopy,
                                             .srcAccessMask = vk::AccessFlagBits2::eTransferWrite,
                                             .dstStageMask = vk::PipelineStageFlagBits2::eHost,
                                             .dstAccessMask = vk::AccessFlagBits2::eHostRead};
            commands.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &to_host});
        });
        std::memcpy(data.data() + row * row_bytes, staging.mapped(), rows * row_bytes);
    });
    return data;
}

}  // namespace pellucid
