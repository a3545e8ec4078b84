#pragma once

#include "gpu/memory.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// SPIR-V embedded at build time; `name` is the shader's file name.
struct ShaderCode {
    std::string_view name;
    std::span<const std::uint32_t> words;
};

/// One binding of set 0, as SPIR-V reflection finds it in the shaders.
struct BindingSlot {
    std::string name;
    std::uint32_t binding = 0;
    vk::DescriptorType type = vk::DescriptorType::eStorageBuffer;
    bool readable = true;
    bool writable = true;
    vk::ShaderStageFlags stages;
};

/// How a fragment's colour joins what the target holds; kMaxAddAlpha: the maximum of red, green and blue, the sum of
/// alpha.
enum class Blend { kReplace, kMultiply, kAdd, kMaxAddAlpha };

/// A compute or graphics pipeline with the bindings its shaders declare.
class Program {
public:
    /// Workgroup size is the shader's own. `constants` are its specialization constants 0, 1, ...
    static Program compute(const Device& device, ShaderCode shader, std::span<const std::uint32_t> constants = {});

    /// Vertex shaders fetch their vertices themselves (gpu/vertices.glsl).
    struct Graphics {
        ShaderCode vertex;
        ShaderCode fragment;
        std::vector<vk::Format> colors;  ///< attachments; empty draws without any
        bool depth = false;              ///< D32 attachment, nearest fragment wins
        Blend blend = Blend::kReplace;
    };
    static Program graphics(const Device& device, const Graphics& state);

    const std::string& name() const { return name_; }
    const std::vector<BindingSlot>& slots() const { return slots_; }
    std::uint32_t push_size() const { return push_size_; }
    vk::ShaderStageFlags stages() const { return stages_; }
    vk::PipelineBindPoint bind_point() const { return bind_point_; }
    vk::Extent2D workgroup() const { return workgroup_; }
    vk::Pipeline pipeline() const { return *pipeline_; }
    vk::PipelineLayout layout() const { return *layout_; }
    vk::DescriptorSetLayout set_layout() const { return *set_layout_; }

private:
    void reflect(ShaderCode shader, vk::ShaderStageFlagBits stage);
    void make_layouts(const Device& device);

    std::string name_;
    std::vector<BindingSlot> slots_;
    std::uint32_t push_size_ = 0;
    vk::ShaderStageFlags stages_;
    vk::PipelineBindPoint bind_point_ = vk::PipelineBindPoint::eGraphics;
    vk::Extent2D workgroup_{1, 1};
    vk::raii::DescriptorSetLayout set_layout_ = nullptr;
    vk::raii::PipelineLayout layout_ = nullptr;
    vk::raii::Pipeline pipeline_ = nullptr;
};

}  // namespace pellucid
