#include "gpu/workspace.h"

#include <span>
#include <utility>

namespace pellucid {

const Program& Workspace::compute(ShaderCode shader, std::span<const Constant> constants) {
    key_ = shader.name;
    for (const auto& [name, value] : constants) {
        key_ += name;
        key_.append(reinterpret_cast<const char*>(&value), sizeof(value));
    }
    return program([&] { return Program::compute(device_, shader, constants); });
}

const Program& Workspace::graphics(const Program::Graphics& state) {
    key_ = state.vertex.name;
    key_ += state.fragment.name;
    const auto append = [&](std::uint32_t word) { key_.append(reinterpret_cast<const char*>(&word), sizeof(word)); };
    append(state.depth ? 1 : 0);
    append(std::uint32_t(state.blend));
    for (const vk::Format format : state.colors) append(std::uint32_t(format));
    return program([&] { return Program::graphics(device_, state); });
}

const GpuImage& Workspace::image(std::string_view name, vk::Format format, vk::Extent2D extent, std::uint32_t layers) {
    using Usage = vk::ImageUsageFlagBits;
    const auto fits = [&](const GpuImage& image) {
        return image.format() == format && image.extent() == extent && image.layers() == layers;
    };
    return kept(images_, name, fits, [&] {
        const vk::ImageUsageFlags usage = format == vk::Format::eD32Sfloat
                                              ? vk::ImageUsageFlags(Usage::eDepthStencilAttachment)
                                              : Usage::eStorage | Usage::eSampled | Usage::eColorAttachment |
                                                    Usage::eTransferSrc | Usage::eTransferDst;
        return GpuImage(device_, std::string(name), format, extent, layers, usage);
    });
}

const Buffer& Workspace::buffer(std::string_view name, vk::DeviceSize size, bool host_visible, vk::Format texels) {
    using Usage = vk::BufferUsageFlagBits;
    const auto fits = [&](const Buffer& buffer) {
        return buffer.size() == size && (buffer.mapped() != nullptr) == host_visible && buffer.texels() == texels;
    };
    return kept(buffers_, name, fits, [&] {
        const vk::BufferUsageFlags usage =
            Usage::eStorageBuffer | Usage::eIndirectBuffer | Usage::eTransferSrc | Usage::eTransferDst;
        return Buffer(device_, std::string(name), size, usage, host_visible, texels);
    });
}

SceneHierarchy& Workspace::hierarchy(const GpuScene& scene, StructureUse use) {
    if (hierarchy_ && !hierarchy_->resource.is_of(scene, use)) hierarchy_.reset();  // freed first: both may not fit
    if (!hierarchy_) hierarchy_.emplace(device_, scene, use);
    hierarchy_->used = true;
    return hierarchy_->resource;
}

void Workspace::drop_older_than(std::uint32_t unused) {
    const auto drop = [unused](auto& entries) {
        std::erase_if(entries, [unused](const auto& entry) { return entry.second.unused > unused; });
    };
    drop(images_);
    drop(buffers_);
}

void Workspace::trim() {
    drop_older_than(kept_frames_);
    for (auto& entry : images_) ++entry.second.unused;
    for (auto& entry : buffers_) ++entry.second.unused;
    if (hierarchy_ && !std::exchange(hierarchy_->used, false)) hierarchy_.reset();
}

void Workspace::clear() {
    images_.clear();
    buffers_.clear();
    hierarchy_.reset();
}

}  // namespace pellucid
