#include "gpu/acceleration_structure.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>

namespace pellucid {
namespace {

using Flag = vk::BuildAccelerationStructureFlagBitsKHR;
using Mode = vk::BuildAccelerationStructureModeKHR;
using Type = vk::AccelerationStructureTypeKHR;

vk::BuildAccelerationStructureFlagsKHR build_flags(StructureUse use) {
    switch (use) {
        case StructureUse::kRefit:
            return Flag::ePreferFastTrace | Flag::eAllowUpdate;
        case StructureUse::kRebuild:
            return Flag::ePreferFastBuild;
        case StructureUse::kStatic:
            break;
    }
    return Flag::ePreferFastTrace;
}

void check_count(const Device& device, const std::string& name, const char* what, std::uint64_t count,
                 std::uint64_t limit) {
    if (count <= limit) return;
    throw Error(fmt::format("{} holds {} {}; {} allows {}", name, count, what, device.info().name, limit));
}

vk::DeviceAddress align_up(vk::DeviceAddress address, vk::DeviceSize alignment) {
    return (address + alignment - 1) / alignment * alignment;
}

}  // namespace

AccelerationStructure::AccelerationStructure(const Device& device, std::string name, Triangles triangles,
                                             StructureUse use)
    : primitive_count_(triangles.corner_count / 3) {
    check_count(device, name, "triangles", primitive_count_, device.ray_tracing()->max_triangles);
    const vk::AccelerationStructureGeometryTrianglesDataKHR data{.vertexFormat = vk::Format::eR32G32B32Sfloat,
                                                                 .vertexData = triangles.vertices,
                                                                 .vertexStride = triangles.stride,
                                                                 .maxVertex = std::max(triangles.vertex_count, 1u) - 1,
                                                                 .indexType = vk::IndexType::eUint32,
                                                                 .indexData = triangles.indices};
    // The geometry is not opaque, because shaders decide which triangles count.
    geometry_ = vk::AccelerationStructureGeometryKHR{.geometryType = vk::GeometryTypeKHR::eTriangles, .geometry = data};
    create(device, std::move(name), Type::eBottomLevel, use);
}

AccelerationStructure::AccelerationStructure(const Device& device, std::string name, Instances instances,
                                             StructureUse use)
    : primitive_count_(instances.count) {
    check_count(device, name, "instances", primitive_count_, device.ray_tracing()->max_instances);
    const vk::AccelerationStructureGeometryInstancesDataKHR data{.data = instances.records};
    geometry_ = vk::AccelerationStructureGeometryKHR{.geometryType = vk::GeometryTypeKHR::eInstances, .geometry = data};
    create(device, std::move(name), Type::eTopLevel, use);
}

void AccelerationStructure::create(const Device& device, std::string name, Type type, StructureUse use) {
    type_ = type;
    flags_ = build_flags(use);
    const vk::AccelerationStructureBuildSizesInfoKHR sizes = device.handle().getAccelerationStructureBuildSizesKHR(
        vk::AccelerationStructureBuildTypeKHR::eDevice, build_info(Mode::eBuild), primitive_count_);
    scratch_size_ = std::max(sizes.buildScratchSize, sizes.updateScratchSize);
    handles_->storage = Buffer(
        device, std::move(name), sizes.accelerationStructureSize,
        vk::BufferUsageFlagBits::eAccelerationStructureStorageKHR | vk::BufferUsageFlagBits::eShaderDeviceAddress);
    handles_->structure = device.handle().createAccelerationStructureKHR(
        {.buffer = handles_->storage.handle(), .size = sizes.accelerationStructureSize, .type = type});
    address_ = device.handle().getAccelerationStructureAddressKHR({.accelerationStructure = *handles_->structure});
}

vk::AccelerationStructureBuildGeometryInfoKHR AccelerationStructure::build_info(Mode mode) const {
    return {.type = type_,
            .flags = flags_,
            .mode = mode,
            .srcAccelerationStructure = mode == Mode::eUpdate ? *handles_->structure : vk::AccelerationStructureKHR(),
            .dstAccelerationStructure = *handles_->structure,
            .geometryCount = 1,
            .pGeometries = &geometry_};
}

// The extra bytes align the address, because a buffer's own alignment may be too small for scratch memory.
BuildScratch::BuildScratch(const Device& device, vk::DeviceSize size)
    : buffer_(device, "scratch memory of acceleration structures", size + device.ray_tracing()->scratch_alignment,
              vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eShaderDeviceAddress),
      address_(align_up(buffer_.address(), device.ray_tracing()->scratch_alignment)) {}

}  // namespace pellucid
