#include "gpu/program.h"

#include <pellucid/error.h>

#include <fmt/format.h>
#include <spirv_cross/spirv_cross.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <stdexcept>

namespace pellucid {
namespace {

vk::raii::ShaderModule make_module(const Device& device, ShaderCode shader) {
    return device.handle().createShaderModule({.codeSize = shader.words.size_bytes(), .pCode = shader.words.data()});
}

vk::PipelineShaderStageCreateInfo stage_info(vk::ShaderStageFlagBits stage, const vk::raii::ShaderModule& module) {
    return {.stage = stage, .module = *module, .pName = "main"};
}

}  // namespace

void ProgramInterface::add(ShaderCode shader, vk::ShaderStageFlagBits stage) {
    const spirv_cross::Compiler compiler(shader.words.data(), shader.words.size());
    const spirv_cross::ShaderResources resources = compiler.get_shader_resources();
    const auto add = [&](const spirv_cross::Resource& resource, vk::DescriptorType type,
                         const spirv_cross::Bitset& flags) {
        const std::string instance = compiler.get_name(resource.id);
        const std::string name = instance.empty() ? resource.name : instance;
        const std::uint32_t binding = compiler.get_decoration(resource.id, spv::DecorationBinding);
        const auto same =
            std::find_if(slots.begin(), slots.end(), [&](const BindingSlot& s) { return s.binding == binding; });
        const bool never_written = type == vk::DescriptorType::eSampledImage ||
                                   type == vk::DescriptorType::eUniformTexelBuffer ||
                                   type == vk::DescriptorType::eAccelerationStructureKHR;
        const bool writable = !never_written && !flags.get(spv::DecorationNonWritable);
        const bool readable = !flags.get(spv::DecorationNonReadable);
        if (same == slots.end()) {
            slots.push_back({name, binding, type, readable, writable, stage});
        } else if (same->name != name || same->type != type) {
            throw std::logic_error(
                fmt::format("binding {} is '{}' in {} and '{}' before", binding, name, shader.name, same->name));
        } else {
            same->readable |= readable;
            same->writable |= writable;
            same->stages |= stage;
        }
    };
    for (const auto& r : resources.storage_buffers) {
        add(r, vk::DescriptorType::eStorageBuffer, compiler.get_buffer_block_flags(r.id));
    }
    for (const auto& r : resources.storage_images) {
        add(r, vk::DescriptorType::eStorageImage, compiler.get_decoration_bitset(r.id));
    }
    for (const auto& r : resources.separate_images) {
        const bool texels = compiler.get_type(r.type_id).image.dim == spv::DimBuffer;
        add(r, texels ? vk::DescriptorType::eUniformTexelBuffer : vk::DescriptorType::eSampledImage,
            compiler.get_decoration_bitset(r.id));
    }
    for (const auto& r : resources.acceleration_structures) {
        add(r, vk::DescriptorType::eAccelerationStructureKHR, compiler.get_decoration_bitset(r.id));
    }
    for (const auto& r : resources.push_constant_buffers) {
        const auto size = std::uint32_t(compiler.get_declared_struct_size(compiler.get_type(r.base_type_id)));
        push_size = std::max(push_size, size);
    }
    if (!resources.uniform_buffers.empty() || !resources.sampled_images.empty()) {
        throw std::logic_error(fmt::format("{}: uniform buffers and combined samplers are not used here", shader.name));
    }
    if (stage == vk::ShaderStageFlagBits::eCompute) {
        workgroup = vk::Extent2D{compiler.get_execution_mode_argument(spv::ExecutionModeLocalSize, 0),
                                 compiler.get_execution_mode_argument(spv::ExecutionModeLocalSize, 1)};
    }
    stages |= stage;
}

ProgramNeeds ProgramInterface::needs() const {
    using Type = vk::DescriptorType;
    const auto most_in_a_stage = [&](std::initializer_list<Type> types) {
        std::uint32_t most = 0;
        for (const BindingSlot& first : slots) {
            most = std::max(most, std::uint32_t(std::ranges::count_if(slots, [&](const BindingSlot& slot) {
                                return (slot.stages & first.stages) && std::ranges::count(types, slot.type) > 0;
                            })));
        }
        return most;
    };
    return {.storage_buffers = most_in_a_stage({Type::eStorageBuffer}),
            .storage_images = most_in_a_stage({Type::eStorageImage}),
            .sampled_images = most_in_a_stage({Type::eSampledImage, Type::eUniformTexelBuffer}),
            .push_bytes = push_size};
}

std::string ProgramNeeds::lacking(const vk::PhysicalDeviceLimits& limits) const {
    struct Need {
        const char* of;
        std::uint32_t needed, limit;
    };
    for (const Need& need :
         {Need{"storage buffers per shader stage", storage_buffers, limits.maxPerStageDescriptorStorageBuffers},
          Need{"storage images per shader stage", storage_images, limits.maxPerStageDescriptorStorageImages},
          Need{"sampled images per shader stage", sampled_images, limits.maxPerStageDescriptorSampledImages},
          Need{"bytes of push constants", push_bytes, limits.maxPushConstantsSize}}) {
        if (need.needed > need.limit) return fmt::format("{} {} (it has {})", need.needed, need.of, need.limit);
    }
    return {};
}

std::string lacking_limit(ShaderCode compute, const vk::PhysicalDeviceLimits& limits) {
    // Reflection takes milliseconds, and renderers ask before every frame.
    static std::mutex mutex;
    static std::map<const std::uint32_t*, ProgramNeeds> known;
    const std::lock_guard lock(mutex);
    const auto [found, first] = known.try_emplace(compute.words.data());
    if (first) {
        ProgramInterface interface;
        interface.add(compute, vk::ShaderStageFlagBits::eCompute);
        found->second = interface.needs();
    }
    return found->second.lacking(limits);
}

void Program::make_layouts(const Device& device) {
    const auto& [slots, push_size, stages, workgroup] = interface_;
    if (const std::string lacking = interface_.needs().lacking(device.limits()); !lacking.empty())
        throw DeviceError(fmt::format("{} needs {}, which {} lacks", name_, lacking, device.info().name));
    std::vector<vk::DescriptorSetLayoutBinding> bindings;
    for (const BindingSlot& slot : slots) {
        bindings.push_back(
            {.binding = slot.binding, .descriptorType = slot.type, .descriptorCount = 1, .stageFlags = slot.stages});
    }
    set_layout_ = device.handle().createDescriptorSetLayout(
        {.bindingCount = std::uint32_t(bindings.size()), .pBindings = bindings.data()});
    const vk::PushConstantRange range{.stageFlags = stages, .offset = 0, .size = push_size};
    const vk::DescriptorSetLayout set = *set_layout_;
    layout_ = device.handle().createPipelineLayout({.setLayoutCount = 1,
                                                    .pSetLayouts = &set,
                                                    .pushConstantRangeCount = push_size > 0 ? 1u : 0u,
                                                    .pPushConstantRanges = &range});
}

Program Program::compute(const Device& device, ShaderCode shader, std::span<const Constant> constants) {
    Program program;
    program.name_ = shader.name;
    program.bind_point_ = vk::PipelineBindPoint::eCompute;
    program.interface_.add(shader, vk::ShaderStageFlagBits::eCompute);
    program.make_layouts(device);
    const vk::raii::ShaderModule module = make_module(device, shader);
    std::vector<vk::SpecializationMapEntry> entries;
    std::vector<std::uint32_t> values;
    const spirv_cross::Compiler compiler(shader.words.data(), shader.words.size());
    for (const spirv_cross::SpecializationConstant& declared : compiler.get_specialization_constants()) {
        const auto given = std::ranges::find(constants, compiler.get_name(declared.id), &Constant::name);
        if (given == constants.end())
            throw std::logic_error(
                fmt::format("{}: no value for the constant '{}'", shader.name, compiler.get_name(declared.id)));
        entries.push_back({.constantID = declared.constant_id, .offset = std::uint32_t(values.size() * 4), .size = 4});
        values.push_back(given->value);
    }
    const vk::SpecializationInfo specialization{.mapEntryCount = std::uint32_t(entries.size()),
                                                .pMapEntries = entries.data(),
                                                .dataSize = values.size() * 4,
                                                .pData = values.data()};
    vk::PipelineShaderStageCreateInfo stage = stage_info(vk::ShaderStageFlagBits::eCompute, module);
    stage.pSpecializationInfo = &specialization;
    ++device.made().pipelines;
    program.pipeline_ = device.handle().createComputePipeline(nullptr, {.stage = stage, .layout = *program.layout_});
    return program;
}

Program Program::graphics(const Device& device, const Graphics& state) {
    Program program;
    program.name_ = state.fragment.name;
    program.interface_.add(state.vertex, vk::ShaderStageFlagBits::eVertex);
    program.interface_.add(state.fragment, vk::ShaderStageFlagBits::eFragment);
    program.make_layouts(device);

    const vk::raii::ShaderModule vertex = make_module(device, state.vertex);
    const vk::raii::ShaderModule fragment = make_module(device, state.fragment);
    const std::array stages = {stage_info(vk::ShaderStageFlagBits::eVertex, vertex),
                               stage_info(vk::ShaderStageFlagBits::eFragment, fragment)};

    const vk::PipelineVertexInputStateCreateInfo vertex_input{};
    const vk::PipelineInputAssemblyStateCreateInfo assembly{.topology = vk::PrimitiveTopology::eTriangleList};
    const vk::PipelineViewportStateCreateInfo viewport{.viewportCount = 1, .scissorCount = 1};
    const vk::PipelineRasterizationStateCreateInfo raster{.polygonMode = vk::PolygonMode::eFill,
                                                          .cullMode = vk::CullModeFlagBits::eNone,
                                                          .frontFace = vk::FrontFace::eCounterClockwise,
                                                          .lineWidth = 1.0f};
    const vk::PipelineMultisampleStateCreateInfo samples{.rasterizationSamples = vk::SampleCountFlagBits::e1};
    const vk::PipelineDepthStencilStateCreateInfo depth{
        .depthTestEnable = state.depth, .depthWriteEnable = state.depth, .depthCompareOp = vk::CompareOp::eLess};
    using Component = vk::ColorComponentFlagBits;
    const bool keeps_maximum = state.blend == Blend::kMaxAddAlpha;
    const vk::PipelineColorBlendAttachmentState blend{
        .blendEnable = state.blend != Blend::kReplace,
        .srcColorBlendFactor = state.blend == Blend::kMultiply ? vk::BlendFactor::eDstColor : vk::BlendFactor::eOne,
        .dstColorBlendFactor = state.blend == Blend::kAdd ? vk::BlendFactor::eOne : vk::BlendFactor::eZero,
        .colorBlendOp = keeps_maximum ? vk::BlendOp::eMax : vk::BlendOp::eAdd,
        .srcAlphaBlendFactor = vk::BlendFactor::eOne,
        .dstAlphaBlendFactor = keeps_maximum ? vk::BlendFactor::eOne : vk::BlendFactor::eZero,
        .alphaBlendOp = vk::BlendOp::eAdd,
        .colorWriteMask = Component::eR | Component::eG | Component::eB | Component::eA};
    const std::vector<vk::PipelineColorBlendAttachmentState> blends(state.colors.size(), blend);
    const vk::PipelineColorBlendStateCreateInfo color{.attachmentCount = std::uint32_t(blends.size()),
                                                      .pAttachments = blends.data()};
    const std::array dynamic_states = {vk::DynamicState::eViewport, vk::DynamicState::eScissor};
    const vk::PipelineDynamicStateCreateInfo dynamic{.dynamicStateCount = std::uint32_t(dynamic_states.size()),
                                                     .pDynamicStates = dynamic_states.data()};
    const vk::PipelineRenderingCreateInfo rendering{
        .colorAttachmentCount = std::uint32_t(state.colors.size()),
        .pColorAttachmentFormats = state.colors.data(),
        .depthAttachmentFormat = state.depth ? vk::Format::eD32Sfloat : vk::Format::eUndefined};
    ++device.made().pipelines;
    program.pipeline_ = device.handle().createGraphicsPipeline(nullptr, {.pNext = &rendering,
                                                                         .stageCount = std::uint32_t(stages.size()),
                                                                         .pStages = stages.data(),
                                                                         .pVertexInputState = &vertex_input,
                                                                         .pInputAssemblyState = &assembly,
                                                                         .pViewportState = &viewport,
                                                                         .pRasterizationState = &raster,
                                                                         .pMultisampleState = &samples,
                                                                         .pDepthStencilState = &depth,
                                                                         .pColorBlendState = &color,
                                                                         .pDynamicState = &dynamic,
                                                                         .layout = *program.layout_});
    return program;
}

}  // namespace pellucid
