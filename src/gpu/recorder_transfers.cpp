// Copies, fills, writes and reads of a Recorder.
#include "gpu/recorder.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace pellucid {
namespace {

using Stage = vk::PipelineStageFlagBits2;
using AccessBit = vk::AccessFlagBits2;

constexpr vk::DeviceSize kReadBufferSize = 1 << 16;
constexpr vk::DeviceSize kWriteBufferSize = 1 << 20;
constexpr std::size_t kLargestUpdate = 65536;  // bytes; limit of vkCmdUpdateBuffer

}  // namespace

void Recorder::clear(const GpuImage& image, vk::ClearColorValue value) {
    synchronise(use_of(image, Stage::eAllTransfer, AccessBit::eTransferWrite, true));
    const vk::ImageSubresourceRange range{
        .aspectMask = vk::ImageAspectFlagBits::eColor, .levelCount = 1, .layerCount = image.layers()};
    commands_.clearColorImage(image.handle(), vk::ImageLayout::eGeneral, value, range, dispatch());
}

void Recorder::clear_layer(const GpuImage& image, std::uint32_t layer, vk::ClearColorValue value) {
    synchronise(use_of(image, Stage::eAllTransfer, AccessBit::eTransferWrite, true));
    const vk::ImageSubresourceRange range{
        .aspectMask = vk::ImageAspectFlagBits::eColor, .levelCount = 1, .baseArrayLayer = layer, .layerCount = 1};
    commands_.clearColorImage(image.handle(), vk::ImageLayout::eGeneral, value, range, dispatch());
}

void Recorder::fill(const Buffer& buffer, vk::DeviceSize offset, vk::DeviceSize bytes, std::uint32_t word) {
    // Use eAllTransfer instead of eClear, because validation layers up to 1.3.239 treat a fill as a copy.
    synchronise(use_of(buffer, Stage::eAllTransfer, AccessBit::eTransferWrite, true));
    commands_.fillBuffer(buffer.handle(), offset, bytes, word, dispatch());
}

void Recorder::copy(const Buffer& source, const Buffer& destination, vk::DeviceSize bytes) {
    std::array uses{use_of(source, Stage::eCopy, AccessBit::eTransferRead, false),
                    use_of(destination, Stage::eCopy, AccessBit::eTransferWrite, true)};
    synchronise(uses);
    commands_.copyBuffer(source.handle(), destination.handle(), vk::BufferCopy{.size = bytes}, dispatch());
}

void Recorder::copy(const Buffer& source, vk::DeviceSize offset, const GpuImage& destination) {
    std::array uses{use_of(source, Stage::eCopy, AccessBit::eTransferRead, false),
                    use_of(destination, Stage::eCopy, AccessBit::eTransferWrite, true)};
    synchronise(uses);
    const vk::BufferImageCopy region{
        .bufferOffset = offset,
        .imageSubresource = {.aspectMask = vk::ImageAspectFlagBits::eColor, .layerCount = 1},
        .imageExtent = {destination.extent().width, destination.extent().height, 1}};
    change_layout(destination.handle(), vk::ImageLayout::eGeneral, vk::ImageLayout::eTransferDstOptimal);
    commands_.copyBufferToImage(source.handle(), destination.handle(), vk::ImageLayout::eTransferDstOptimal, region,
                                dispatch());
    change_layout(destination.handle(), vk::ImageLayout::eTransferDstOptimal, vk::ImageLayout::eGeneral);
}

void Recorder::copy_from(vk::Image source, vk::ImageLayout layout, const GpuImage& destination) {
    synchronise(use_of(destination, Stage::eAllTransfer, AccessBit::eTransferWrite, true));
    const vk::ImageSubresourceLayers layer{.aspectMask = vk::ImageAspectFlagBits::eColor, .layerCount = 1};
    const vk::Offset3D end{std::int32_t(destination.extent().width), std::int32_t(destination.extent().height), 1};
    const std::array corners{vk::Offset3D{}, end};
    const vk::ImageBlit region{
        .srcSubresource = layer, .srcOffsets = corners, .dstSubresource = layer, .dstOffsets = corners};
    change_layout(destination.handle(), vk::ImageLayout::eGeneral, vk::ImageLayout::eTransferDstOptimal);
    commands_.blitImage(source, layout, destination.handle(), vk::ImageLayout::eTransferDstOptimal, region,
                        vk::Filter::eNearest, dispatch());
    change_layout(destination.handle(), vk::ImageLayout::eTransferDstOptimal, vk::ImageLayout::eGeneral);
}

void Recorder::copy_depths_from(vk::Image source, vk::ImageLayout layout, vk::Extent2D extent,
                                const Buffer& destination) {
    synchronise(use_of(destination, Stage::eCopy, AccessBit::eTransferWrite, true));
    const vk::BufferImageCopy region{
        .imageSubresource = {.aspectMask = vk::ImageAspectFlagBits::eDepth, .layerCount = 1},
        .imageExtent = {extent.width, extent.height, 1}};
    commands_.copyImageToBuffer(source, layout, destination.handle(), region, dispatch());
}

std::byte* Recorder::stage(vk::DeviceSize bytes, const Buffer*& buffer, vk::DeviceSize& offset) {
    while (staging_used_ == 0 || staging_end_ + bytes > staging_[staging_used_ - 1].size()) {
        if (staging_used_ == staging_.size()) {
            staging_.emplace_back(device_, "values written", std::max(bytes, kWriteBufferSize),
                                  vk::BufferUsageFlagBits::eTransferSrc, true);
        }
        ++staging_used_;
        staging_end_ = 0;
    }
    buffer = &staging_[staging_used_ - 1];
    offset = std::exchange(staging_end_, staging_end_ + bytes);
    return buffer->mapped() + offset;
}

void Recorder::write_bytes(const PendingUpload& to, std::span<const std::byte> data) {
    if (data.empty()) return;
    synchronise({to.id, Stage::eAllTransfer, AccessBit::eTransferWrite, true, to.held});
    if (data.size() <= kLargestUpdate) {
        commands_.updateBuffer(to.buffer, to.offset, data.size(), data.data(), dispatch());
        return;
    }
    const Buffer* from = nullptr;
    vk::DeviceSize at = 0;
    std::memcpy(stage(data.size(), from, at), data.data(), data.size());
    commands_.copyBuffer(from->handle(), to.buffer, vk::BufferCopy{at, to.offset, data.size()}, dispatch());
}

void Recorder::upload_pending() {
    for (PendingUpload& pending : device_.take_uploads()) {
        write_bytes(pending, pending.data);
        uploads_.push_back(std::move(pending));
    }
}

/// Changes the layout of a colour image. Waits for all earlier commands, and all later commands wait for the change.
void Recorder::change_layout(vk::Image image, vk::ImageLayout from, vk::ImageLayout to) {
    const auto everything = AccessBit::eMemoryRead | AccessBit::eMemoryWrite;
    const vk::ImageMemoryBarrier2 barrier{
        .srcStageMask = Stage::eAllCommands,
        .srcAccessMask = everything,
        .dstStageMask = Stage::eAllCommands,
        .dstAccessMask = everything,
        .oldLayout = from,
        .newLayout = to,
        .image = image,
        .subresourceRange = {.aspectMask = vk::ImageAspectFlagBits::eColor, .levelCount = 1, .layerCount = 1}};
    commands_.pipelineBarrier2({.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier}, dispatch());
}

void Recorder::copy_to(const GpuImage& source, vk::Image target, vk::Offset2D at, vk::ImageLayout before,
                       vk::ImageLayout after) {
    synchronise(use_of(source, Stage::eCopy, AccessBit::eTransferRead, false));
    const vk::ImageSubresourceLayers layer{.aspectMask = vk::ImageAspectFlagBits::eColor, .layerCount = 1};
    change_layout(target, before, vk::ImageLayout::eTransferDstOptimal);
    const vk::ImageCopy region{.srcSubresource = layer,
                               .dstSubresource = layer,
                               .dstOffset = {at.x, at.y, 0},
                               .extent = {source.extent().width, source.extent().height, 1}};
    commands_.copyImage(source.handle(), vk::ImageLayout::eGeneral, target, vk::ImageLayout::eTransferDstOptimal,
                        region, dispatch());
    change_layout(target, vk::ImageLayout::eTransferDstOptimal, after);
}

// Values get separate ranges of the host buffers, so no copy waits for another.
const std::byte* Recorder::read_bytes(const Buffer& source, vk::DeviceSize offset, vk::DeviceSize bytes) {
    if (read_end_ % kReadBufferSize + bytes > kReadBufferSize)
        read_end_ += kReadBufferSize - read_end_ % kReadBufferSize;
    const std::size_t number = read_end_ / kReadBufferSize;
    const vk::DeviceSize at = read_end_ % kReadBufferSize;
    read_end_ += bytes;
    if (number == read_buffers_.size()) {
        read_buffers_.emplace_back(device_, "values read", kReadBufferSize, vk::BufferUsageFlagBits::eTransferDst,
                                   true);
    }
    synchronise(use_of(source, Stage::eCopy, AccessBit::eTransferRead, false));
    commands_.copyBuffer(source.handle(), read_buffers_[number].handle(), vk::BufferCopy{offset, at, bytes},
                         dispatch());
    return read_buffers_[number].mapped() + at;
}

}  // namespace pellucid
