#include "gpu/counted_buffer.h"
#include "gpu/shaders.h"

#include <fmt/format.h>
#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace pellucid {
namespace {

constexpr vk::DeviceSize kHeaderSize = 16;

}  // namespace

std::uint32_t CountedBuffer::limit(const Device& device) const {
    const vk::DeviceSize bytes = std::min<vk::DeviceSize>(device.max_storage_binding(), device.max_allocation());
    const vk::DeviceSize texels = texels_ == vk::Format::eUndefined
                                      ? bytes
                                      : vk::DeviceSize(device.limits().maxTexelBufferElements) * texel_size(texels_);
    // Shaders use signed integers for item numbers.
    return std::uint32_t(std::min<vk::DeviceSize>((std::min(bytes, texels) - kHeaderSize) / item_size_, 0x7ffffff0u));
}

const Buffer& CountedBuffer::begin(Recorder& recorder, Workspace& workspace, std::uint64_t guess) {
    limit_ = limit(workspace.device());
    if (capacity_ == 0) set_capacity(std::min<std::uint64_t>(guess, limit_));
    if (capacity_ > limit_) {
        throw TooLarge(
            fmt::format("{} has room for {} {}, not for {}", workspace.device().info().name, limit_, name_, capacity_));
    }
    buffer_ = &workspace.buffer(name_, kHeaderSize + capacity_ * item_size_, host_visible_, texels_);
    recorder.fill(*buffer_, 0, kHeaderSize, 0);
    return *buffer_;
}

void CountedBuffer::end(Recorder& recorder, std::function<void(std::uint32_t)> then) {
    recorder.read<glm::uvec2>(*buffer_, 0, [counted = counted_, then = std::move(then)](const glm::uvec2& counts) {
        const std::uint32_t items = std::max(counts.x, counts.y);
        *counted = std::max(*counted, items);
        if (then) then(items);
    });
}

const Buffer& CountedBuffer::groups(Recorder& recorder, Workspace& workspace) const {
    const Buffer& groups = workspace.buffer(name_ + " groups", 3 * sizeof(std::uint32_t));
    recorder.compute(workspace.compute(shaders::dispatch_counted_comp),
                     {reads("Counted", *buffer_), writes("Groups", groups)},
                     std::array{capacity_, workspace.device().limits().maxComputeWorkGroupCount[0]}, {1, 1});
    return groups;
}

bool CountedBuffer::grow() {
    const std::uint32_t needed = std::exchange(*counted_, 0);
    if (needed <= capacity_) return false;
    set_capacity(std::max<std::uint64_t>(needed, std::min<std::uint64_t>(limit_, needed + std::uint64_t(needed) / 4)));
    return true;
}

}  // namespace pellucid
