#include "gpu/binding.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace pellucid {
namespace {

std::string_view access_name(bool readable, bool writable) {
    return readable && writable ? "reads and writes" : writable ? "writes" : "reads";
}

void check_access(const Program& program, const BindingSlot& slot, const Binding& binding) {
    const bool reads_it = binding.access != Access::kWrite;
    const bool writes_it = binding.access != Access::kRead;
    if (reads_it == slot.readable && writes_it == slot.writable) return;
    throw std::logic_error(fmt::format("{}: the shader {} '{}', the pass {} it", program.name(),
                                       access_name(slot.readable, slot.writable), slot.name,
                                       access_name(reads_it, writes_it)));
}

/// The pass's own bindings take precedence over those of groups.
const Binding* find_binding(Bindings bindings, std::string_view name) {
    const Binding* found = nullptr;
    for (const Binding& binding : bindings) {
        if (binding.group == nullptr && binding.name == name) return &binding;
        if (binding.group != nullptr && found == nullptr) found = find_binding(*binding.group, name);
    }
    return found;
}

}  // namespace

vk::PipelineStageFlags2 stages_of(const BindingSlot& slot) {
    vk::PipelineStageFlags2 stages;
    if (slot.stages & vk::ShaderStageFlagBits::eCompute) stages |= vk::PipelineStageFlagBits2::eComputeShader;
    if (slot.stages & vk::ShaderStageFlagBits::eVertex) stages |= vk::PipelineStageFlagBits2::eVertexShader;
    if (slot.stages & vk::ShaderStageFlagBits::eFragment) stages |= vk::PipelineStageFlagBits2::eFragmentShader;
    return stages;
}

vk::AccessFlags2 access_of(const BindingSlot& slot) {
    if (slot.type == vk::DescriptorType::eAccelerationStructureKHR)
        return vk::AccessFlagBits2::eAccelerationStructureReadKHR;
    const bool sampled =
        slot.type == vk::DescriptorType::eSampledImage || slot.type == vk::DescriptorType::eUniformTexelBuffer;
    const vk::AccessFlags2 read =
        sampled ? vk::AccessFlagBits2::eShaderSampledRead : vk::AccessFlagBits2::eShaderStorageRead;
    vk::AccessFlags2 flags;
    if (slot.readable) flags |= read;
    if (slot.writable) flags |= vk::AccessFlagBits2::eShaderStorageWrite;
    return flags;
}

const Binding& binding_of(const Program& program, const BindingSlot& slot, Bindings bindings) {
    const Binding* const match = find_binding(bindings, slot.name);
    if (match == nullptr) {
        throw std::logic_error(
            fmt::format("{}: the shader declares '{}', the pass binds no such name", program.name(), slot.name));
    }
    const bool wants_texels = slot.type == vk::DescriptorType::eUniformTexelBuffer;
    const bool wants_buffer = slot.type == vk::DescriptorType::eStorageBuffer || wants_texels;
    const bool wants_structure = slot.type == vk::DescriptorType::eAccelerationStructureKHR;
    if (wants_buffer != (match->buffer != nullptr) || wants_structure != (match->structure != nullptr)) {
        throw std::logic_error(fmt::format("{}: the shader declares '{}' as {}, the pass binds the other kind",
                                           program.name(), slot.name, vk::to_string(slot.type)));
    }
    if (wants_texels && match->buffer->texels() == vk::Format::eUndefined) {
        throw std::logic_error(fmt::format("{}: the shader reads '{}' as a texel buffer, '{}' is none", program.name(),
                                           slot.name, match->buffer->name()));
    }
    return *match;
}

void check_own(const Program& program, Bindings bindings) {
    for (const Binding& binding : bindings) {
        if (binding.group != nullptr) continue;
        const auto slot = std::ranges::find(program.slots(), binding.name, &BindingSlot::name);
        if (slot == program.slots().end() || find_binding(bindings, binding.name) != &binding) {
            throw std::logic_error(
                fmt::format("{}: the pass binds '{}', which the shader does not declare, or a second time",
                            program.name(), binding.name));
        }
        check_access(program, *slot, binding);
    }
}

}  // namespace pellucid
