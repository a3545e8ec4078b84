#pragma once

#include "gpu/memory.h"

#include <cstdint>
#include <string>

namespace pellucid {

/// What an acceleration structure is made for.
enum class StructureUse {
    kStatic,   ///< built once, traced often: a good tree over triangles that stay
    kRefit,    ///< the same tree, its boxes fitted again to triangles that have moved
    kRebuild,  ///< built anew in every frame: fast
};

/// One level of the hierarchy that rays go through (VkAccelerationStructureKHR): triangles of a mesh,
/// or placements of such structures. Empty until Recorder::build(). Needs Device::ray_tracing().
class AccelerationStructure {
public:
    /// Triangles: three 32-bit indices each into vertices `stride` bytes apart, which begin with their position
    /// (3 floats).
    struct Triangles {
        vk::DeviceAddress vertices;
        std::uint32_t stride;
        std::uint32_t vertex_count;
        vk::DeviceAddress indices;
        std::uint32_t corner_count;
    };
    /// Records of vk::AccelerationStructureInstanceKHR.
    struct Instances {
        vk::DeviceAddress records;
        std::uint32_t count;
    };
    /// Throw Error if the device builds none of this size, naming `name`.
    AccelerationStructure(const Device& device, std::string name, Triangles triangles, StructureUse use);
    AccelerationStructure(const Device& device, std::string name, Instances instances, StructureUse use);

    vk::AccelerationStructureKHR handle() const { return *handles_->structure; }
    vk::DeviceAddress address() const { return address_; }
    ResourceId id() const { return handles_->storage.id(); }
    /// As Buffer::held().
    std::shared_ptr<const void> held() const { return handles_; }

    /// Bytes of scratch memory that building it, or refitting it, needs at most.
    vk::DeviceSize scratch_size() const { return scratch_size_; }
    /// The build as vkCmdBuildAccelerationStructuresKHR wants it; pGeometries points into this object.
    vk::AccelerationStructureBuildGeometryInfoKHR build_info(vk::BuildAccelerationStructureModeKHR mode) const;
    std::uint32_t primitive_count() const { return primitive_count_; }

private:
    void create(const Device& device, std::string name, vk::AccelerationStructureTypeKHR type, StructureUse use);

    struct Handles {
        Buffer storage;  // outlives the structure
        vk::raii::AccelerationStructureKHR structure = nullptr;
    };
    std::shared_ptr<Handles> handles_ = std::make_shared<Handles>();
    vk::DeviceAddress address_ = 0;
    vk::AccelerationStructureTypeKHR type_ = vk::AccelerationStructureTypeKHR::eGeneric;
    vk::BuildAccelerationStructureFlagsKHR flags_;
    vk::AccelerationStructureGeometryKHR geometry_;
    std::uint32_t primitive_count_ = 0;
    vk::DeviceSize scratch_size_ = 0;
};

/// Scratch memory for builds that need `size` bytes at most.
class BuildScratch {
public:
    BuildScratch(const Device& device, vk::DeviceSize size);
    vk::DeviceAddress address() const { return address_; }  ///< aligned as the device wants it
    ResourceId id() const { return buffer_.id(); }
    std::shared_ptr<const void> held() const { return buffer_.held(); }

private:
    Buffer buffer_;
    vk::DeviceAddress address_;
};

}  // namespace pellucid
