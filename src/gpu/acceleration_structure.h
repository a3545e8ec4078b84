#pragma once

#include "gpu/memory.h"

#include <cstdint>
#include <string>

namespace pellucid {

/// The use of an acceleration structure, which decides how it is built.
enum class StructureUse {
    kStatic,   ///< built once for fast tracing of static triangles
    kRefit,    ///< built for fast tracing; refitted to moved triangles, with the same tree
    kRebuild,  ///< rebuilt in every frame, with fast builds
};

/// One level of a hierarchy for ray tracing (VkAccelerationStructureKHR): triangles of a mesh, or instances of such
/// structures. Empty until Recorder::build(). Needs Device::ray_tracing().
class AccelerationStructure {
public:
    /// Triangles with three 32-bit indices each. Vertices are `stride` bytes apart; the first 3 floats are the
    /// position.
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
    /// Throws Error, with `name`, if the device does not support this number of triangles or instances.
    AccelerationStructure(const Device& device, std::string name, Triangles triangles, StructureUse use);
    AccelerationStructure(const Device& device, std::string name, Instances instances, StructureUse use);

    vk::AccelerationStructureKHR handle() const { return *handles_->structure; }
    vk::DeviceAddress address() const { return address_; }
    ResourceId id() const { return handles_->storage.id(); }
    /// Like Buffer::held().
    std::shared_ptr<const void> held() const { return handles_; }

    /// Largest scratch memory of a build or refit, bytes.
    vk::DeviceSize scratch_size() const { return scratch_size_; }
    /// Arguments of vkCmdBuildAccelerationStructuresKHR. pGeometries points into this object.
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

/// Scratch memory for builds that need up to `size` bytes.
class BuildScratch {
public:
    BuildScratch(const Device& device, vk::DeviceSize size);
    vk::DeviceAddress address() const { return address_; }  ///< with the alignment that the device needs
    ResourceId id() const { return buffer_.id(); }
    std::shared_ptr<const void> held() const { return buffer_.held(); }

private:
    Buffer buffer_;
    vk::DeviceAddress address_;
};

}  // namespace pellucid
