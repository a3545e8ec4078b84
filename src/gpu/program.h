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

/// A specialization constant by the name that the shader gives it; booleans are 0 or 1.
struct Constant {
    std::string_view name;
    std::uint32_t value;
};

/// How much of what devices limit the shaders of a program take.
struct ProgramNeeds {
    std::uint32_t storage_buffers = 0, storage_images = 0, sampled_images = 0;  ///< per shader stage
    std::uint32_t push_bytes = 0;

    /// The first limit that they exceed, in words that follow "needs"; empty: none.
    std::string lacking(const vk::PhysicalDeviceLimits& limits) const;
};

/// The bindings and push constants of shaders, as SPIR-V reflection finds them.
struct ProgramInterface {
    std::vector<BindingSlot> slots;
    std::uint32_t push_size = 0;  ///< bytes
    vk::ShaderStageFlags stages;
    vk::Extent2D workgroup{1, 1};  ///< of a compute shader

    /// Throws std::logic_error if the shader disagrees with those before.
    void add(ShaderCode shader, vk::ShaderStageFlagBits stage);
    ProgramNeeds needs() const;
};
/// The first limit that a compute shader exceeds, in words that follow "needs"; empty: none.
std::string lacking_limit(ShaderCode compute, const vk::PhysicalDeviceLimits& limits);

/// How a fragment's colour joins what the target holds; kMaxAddAlpha: the maximum of red, green and blue, the sum of
/// alpha.
enum class Blend { kReplace, kMultiply, kAdd, kMaxAddAlpha };

/// A compute or graphics pipeline with the bindings its shaders declare. Making one throws DeviceError, naming the limit,
/// if the device has fewer.
class Program {
public:
    /// Workgroup size is the shader's own. Every specialization constant of the shader has to be in `constants`, where
    /// there may be others; throws std::logic_error if one is not.
    static Program compute(const Device& device, ShaderCode shader, std::span<const Constant> constants = {});

    /// Vertex shaders fetch their vertices themselves (gpu/vertices.glsl).
    struct Graphics {
        ShaderCode vertex;
        ShaderCode fragment;
        std::vector<vk::Format> colors = {};  ///< attachments; empty draws without any
        bool depth = false;                   ///< D32 attachment, nearest fragment wins
        Blend blend = Blend::kReplace;
    };
    static Program graphics(const Device& device, const Graphics& state);

    const std::string& name() const { return name_; }
    const std::vector<BindingSlot>& slots() const { return interface_.slots; }
    std::uint32_t push_size() const { return interface_.push_size; }
    vk::ShaderStageFlags stages() const { return interface_.stages; }
    vk::PipelineBindPoint bind_point() const { return bind_point_; }
    vk::Extent2D workgroup() const { return interface_.workgroup; }
    vk::Pipeline pipeline() const { return *pipeline_; }
    vk::PipelineLayout layout() const { return *layout_; }
    vk::DescriptorSetLayout set_layout() const { return *set_layout_; }

private:
    void make_layouts(const Device& device);

    std::string name_;
    ProgramInterface interface_;
    vk::PipelineBindPoint bind_point_ = vk::PipelineBindPoint::eGraphics;
    vk::raii::DescriptorSetLayout set_layout_ = nullptr;
    vk::raii::PipelineLayout layout_ = nullptr;
    vk::raii::Pipeline pipeline_ = nullptr;
};

}  // namespace pellucid
