#include "gpu/recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace pellucid {
namespace {

using Stage = vk::PipelineStageFlagBits2;
using AccessBit = vk::AccessFlagBits2;

constexpr std::uint32_t kQueriesPerPool = 64;
constexpr std::uint32_t kSetsPerPool = 64;
constexpr std::uint32_t kDescriptorsPerPool = 16 * kSetsPerPool;

}  // namespace

Recorder::Recorder(const Device& device) : device_(device) {
    const auto& handle = device.handle();
    ++device.made().pools;
    pool_ = handle.createCommandPool({.queueFamilyIndex = device.queue_family()});
    fence_ = handle.createFence({});
    restart();
}

void Recorder::restart(vk::CommandBuffer commands) {
    device_.give_uploads_back(std::exchange(uploads_, {}));  // these uploads did not run
    parts_.clear();
    pool_.reset();
    own_used_ = 0;
    for (const auto& pool : descriptor_pools_) pool.reset();
    descriptor_pool_ = 0;
    scopes_.clear();
    in_scope_ = false;
    timestamps_ = 0;
    states_.clear();
    when_done_.clear();
    read_end_ = staging_end_ = 0;
    staging_used_ = 0;
    callers_ = bool(commands);
    commands_ = commands;
    begin_commands();
}

void Recorder::begin_commands() {
    if (!callers_) {
        if (own_used_ == own_.size()) {
            const vk::CommandBufferAllocateInfo one{.commandPool = *pool_, .commandBufferCount = 1};
            own_.push_back(std::move(device_.handle().allocateCommandBuffers(one).front()));
        }
        commands_ = *own_[own_used_++];
        commands_.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit}, dispatch());
    }
    // Writes of the host and of earlier submissions become visible here. Later accesses are tracked in states_.
    const vk::MemoryBarrier2 all{.srcStageMask = Stage::eAllCommands,
                                 .srcAccessMask = AccessBit::eMemoryWrite,
                                 .dstStageMask = Stage::eAllCommands,
                                 .dstAccessMask = AccessBit::eMemoryRead | AccessBit::eMemoryWrite};
    commands_.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &all}, dispatch());
}

void Recorder::synchronise(std::span<Use> uses) {
    vk::MemoryBarrier2 barrier;
    for (const Use& use : uses) {
        State& state = states_[use.id];
        const auto seen = [&] { return std::ranges::any_of(state.reads, [&](const Use& r) { return r.covers(use); }); };
        if (state.write && (use.write || !seen())) {
            barrier.srcStageMask |= state.write->stage;
            barrier.srcAccessMask |= state.write->access;
        }
        if (!use.write) continue;
        for (const Use& read : state.reads) barrier.srcStageMask |= read.stage;
    }
    if (barrier.srcStageMask) {
        for (const Use& use : uses) {
            barrier.dstStageMask |= use.stage;
            barrier.dstAccessMask |= use.access;
        }
        commands_.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &barrier}, dispatch());
    }
    for (Use& use : uses) {
        State& state = states_[use.id];
        if (!state.holder) state.holder = std::move(use.holder);
        use.holder.reset();
        if (use.write) {
            state.write = use;
            state.reads.clear();
        } else if (std::ranges::none_of(state.reads, [&](const Use& read) { return read.covers(use); })) {
            state.reads.push_back(use);
        }
    }
}

vk::DescriptorSet Recorder::allocate_set(const Program& program) {
    const auto& handle = device_.handle();
    const vk::DescriptorSetLayout layout = program.set_layout();
    for (bool fresh = false;; ++descriptor_pool_) {
        if (descriptor_pool_ == descriptor_pools_.size()) {
            std::vector<vk::DescriptorPoolSize> sizes = {
                {vk::DescriptorType::eStorageBuffer, kDescriptorsPerPool},
                {vk::DescriptorType::eStorageImage, kDescriptorsPerPool},
                {vk::DescriptorType::eSampledImage, kDescriptorsPerPool},
                {vk::DescriptorType::eUniformTexelBuffer, kDescriptorsPerPool}};
            if (device_.ray_tracing()) {
                sizes.push_back({vk::DescriptorType::eAccelerationStructureKHR, kSetsPerPool});
            }
            ++device_.made().pools;
            descriptor_pools_.push_back(handle.createDescriptorPool(
                {.maxSets = kSetsPerPool, .poolSizeCount = std::uint32_t(sizes.size()), .pPoolSizes = sizes.data()}));
            fresh = true;
        }
        const vk::DescriptorSetAllocateInfo info{
            .descriptorPool = *descriptor_pools_[descriptor_pool_], .descriptorSetCount = 1, .pSetLayouts = &layout};
        // The pool frees its sets, so use a plain handle instead of a RAII one.
        VkDescriptorSet set = VK_NULL_HANDLE;
        const VkDescriptorSetAllocateInfo& plain = info;
        const VkResult result = handle.getDispatcher()->vkAllocateDescriptorSets(*handle, &plain, &set);
        if (result == VK_SUCCESS) return set;
        const bool full = result == VK_ERROR_OUT_OF_POOL_MEMORY || result == VK_ERROR_FRAGMENTED_POOL;
        if (!full || fresh) vk::throwResultException(vk::Result(result), program.name().c_str());
    }
}

void Recorder::bind(const Program& program, Bindings bindings, std::span<const std::byte> push) {
    const bool graphics = program.bind_point() == vk::PipelineBindPoint::eGraphics;
    const std::size_t push_offset = graphics ? sizeof(DrawCall::object) : 0;  // each draw sets the object itself
    if (push_offset + push.size() != program.push_size()) {
        throw std::logic_error(fmt::format("{}: the shader has {} bytes of push constants, the pass {}", program.name(),
                                           program.push_size(), push_offset + push.size()));
    }
    const std::size_t count = program.slots().size();
    auto& [set_writes, buffers, images, texels, structures, structure_writes] = descriptors_;
    set_writes.clear();
    buffers.resize(count);
    images.resize(count);
    texels.resize(count);
    structures.resize(count);
    structure_writes.resize(count);
    uses_.clear();
    const vk::DescriptorSet set = allocate_set(program);
    for (const BindingSlot& slot : program.slots()) {
        const Binding& binding = binding_of(program, slot, bindings);
        const std::size_t i = set_writes.size();
        vk::WriteDescriptorSet& write = set_writes.emplace_back(vk::WriteDescriptorSet{
            .dstSet = set, .dstBinding = slot.binding, .descriptorCount = 1, .descriptorType = slot.type});
        const auto add_use = [&](const auto& resource) {
            uses_.push_back(use_of(resource, stages_of(slot), access_of(slot), slot.writable));
        };
        if (slot.type == vk::DescriptorType::eUniformTexelBuffer) {
            texels[i] = binding.buffer->texel_view();
            write.pTexelBufferView = &texels[i];
            add_use(*binding.buffer);
        } else if (binding.buffer) {
            buffers[i] =
                vk::DescriptorBufferInfo{.buffer = binding.buffer->handle(), .offset = 0, .range = VK_WHOLE_SIZE};
            write.pBufferInfo = &buffers[i];
            add_use(*binding.buffer);
        } else if (binding.image) {
            images[i] = vk::DescriptorImageInfo{
                .imageView = binding.layer ? binding.image->layer_view(*binding.layer) : binding.image->array_view(),
                .imageLayout = vk::ImageLayout::eGeneral};
            write.pImageInfo = &images[i];
            add_use(*binding.image);
        } else {
            structures[i] = binding.structure->handle();
            structure_writes[i] = {.accelerationStructureCount = 1, .pAccelerationStructures = &structures[i]};
            write.pNext = &structure_writes[i];
            add_use(*binding.structure);
        }
    }
    check_own(program, bindings);
    device_.handle().updateDescriptorSets(set_writes, nullptr);
    commands_.bindPipeline(program.bind_point(), program.pipeline(), dispatch());
    commands_.bindDescriptorSets(program.bind_point(), program.layout(), 0, set, nullptr, dispatch());
    if (!push.empty()) {
        commands_.pushConstants(program.layout(), program.stages(), std::uint32_t(push_offset),
                                std::uint32_t(push.size()), push.data(), dispatch());
    }
}

void Recorder::compute_bytes(const Program& program, Bindings bindings, std::span<const std::byte> push,
                             vk::Extent2D threads) {
    bind(program, bindings, push);
    synchronise(uses_);
    const vk::Extent2D group = program.workgroup();
    commands_.dispatch((threads.width + group.width - 1) / group.width,
                       (threads.height + group.height - 1) / group.height, 1, dispatch());
}

void Recorder::compute_indirect_bytes(const Program& program, Bindings bindings, std::span<const std::byte> push,
                                      const Buffer& arguments) {
    bind(program, bindings, push);
    uses_.push_back(use_of(arguments, Stage::eDrawIndirect, AccessBit::eIndirectCommandRead, false));
    synchronise(uses_);
    commands_.dispatchIndirect(arguments.handle(), 0, dispatch());
}

void Recorder::draw_bytes(const Program& program, Bindings bindings, std::span<const std::byte> push,
                          const RenderTarget& target, std::span<const DrawCall> calls) {
    bind(program, bindings, push);
    const auto attachment = [](const RenderTarget::Attachment& a) {
        return vk::RenderingAttachmentInfo{
            .imageView = a.image->layer_view(a.layer),
            .imageLayout = vk::ImageLayout::eGeneral,
            .loadOp = a.clear ? vk::AttachmentLoadOp::eClear : vk::AttachmentLoadOp::eLoad,
            .storeOp = vk::AttachmentStoreOp::eStore,
            .clearValue = a.clear.value_or(vk::ClearValue{})};
    };
    std::vector<vk::RenderingAttachmentInfo> colors;
    for (const auto& a : target.colors) {
        colors.push_back(attachment(a));
        uses_.push_back(use_of(*a.image, Stage::eColorAttachmentOutput,
                               AccessBit::eColorAttachmentRead | AccessBit::eColorAttachmentWrite, true));
    }
    vk::RenderingAttachmentInfo depth;
    if (target.depth) {
        depth = attachment(*target.depth);
        uses_.push_back(use_of(*target.depth->image, Stage::eEarlyFragmentTests | Stage::eLateFragmentTests,
                               AccessBit::eDepthStencilAttachmentRead | AccessBit::eDepthStencilAttachmentWrite, true));
    }
    synchronise(uses_);

    const vk::Rect2D everything{{0, 0}, target.extent};
    commands_.beginRendering({.renderArea = everything,
                              .layerCount = 1,
                              .colorAttachmentCount = std::uint32_t(colors.size()),
                              .pColorAttachments = colors.data(),
                              .pDepthAttachment = target.depth ? &depth : nullptr},
                             dispatch());
    const vk::Viewport viewport{0.0f, 0.0f, float(target.extent.width), float(target.extent.height), 0.0f, 1.0f};
    commands_.setViewport(0, viewport, dispatch());
    commands_.setScissor(0, target.scissor.extent.width > 0 ? target.scissor : everything, dispatch());
    for (const DrawCall& call : calls) {
        commands_.pushConstants(program.layout(), program.stages(), 0, sizeof(call.object), &call.object, dispatch());
        commands_.draw(call.corner_count, 1, call.first_corner, 0, dispatch());
    }
    commands_.endRendering(dispatch());
}

// Bindings need to name only the top structure. Its build waits for the builds of its instances, and barriers cover all
// memory. So a wait for the top structure is also a wait for its instances.
void Recorder::build(const AccelerationStructure& structure, vk::BuildAccelerationStructureModeKHR mode,
                     std::span<const ResourceId> inputs, const BuildScratch& scratch) {
    const auto stage = Stage::eAccelerationStructureBuildKHR;
    const auto read = AccessBit::eAccelerationStructureReadKHR;
    const auto write = AccessBit::eAccelerationStructureWriteKHR;
    std::vector<Use> uses = {use_of(structure, stage, read | write, true), use_of(scratch, stage, read | write, true)};
    for (const ResourceId input : inputs) uses.push_back({input, stage, AccessBit::eShaderRead | read, false});
    synchronise(uses);
    vk::AccelerationStructureBuildGeometryInfoKHR info = structure.build_info(mode);
    info.scratchData.deviceAddress = scratch.address();
    const vk::AccelerationStructureBuildRangeInfoKHR range{.primitiveCount = structure.primitive_count()};
    commands_.buildAccelerationStructuresKHR(info, &range, dispatch());
}

void Recorder::write_timestamp(Stage stage) {
    if (device_.timestamp_period_ns() == 0.0) return;
    const std::uint32_t pool = timestamps_ / kQueriesPerPool;
    const std::uint32_t query = timestamps_ % kQueriesPerPool;
    if (pool == query_pools_.size()) {
        ++device_.made().pools;
        query_pools_.push_back(
            device_.handle().createQueryPool({.queryType = vk::QueryType::eTimestamp, .queryCount = kQueriesPerPool}));
    }
    if (query == 0) commands_.resetQueryPool(*query_pools_[pool], 0, kQueriesPerPool, dispatch());
    commands_.writeTimestamp2(stage, *query_pools_[pool], query, dispatch());
    ++timestamps_;
}

void Recorder::begin_label() {
    if (device_.debug_labels()) commands_.beginDebugUtilsLabelEXT({.pLabelName = scopes_.back().c_str()}, dispatch());
}

void Recorder::end_label() {
    if (device_.debug_labels()) commands_.endDebugUtilsLabelEXT(dispatch());
}

Recorder::Scope::Scope(Recorder& recorder, std::string_view name) : recorder_(recorder) {
    recorder_.scopes_.emplace_back(name);
    recorder_.in_scope_ = true;
    recorder_.begin_label();
    recorder_.write_timestamp(Stage::eAllCommands);
}

Recorder::Scope::~Scope() {
    recorder_.write_timestamp(Stage::eAllCommands);
    recorder_.end_label();
    recorder_.in_scope_ = false;
}

std::vector<PassTime> Recorder::read_times() const {
    std::vector<std::uint64_t> ticks;
    for (std::uint32_t first = 0; first < timestamps_; first += kQueriesPerPool) {
        const std::uint32_t count = std::min(kQueriesPerPool, timestamps_ - first);
        const auto [result, values] = query_pools_[first / kQueriesPerPool].getResults<std::uint64_t>(
            0, count, count * sizeof(std::uint64_t), sizeof(std::uint64_t),
            vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
        ticks.insert(ticks.end(), values.begin(), values.end());
    }
    std::vector<PassTime> times;
    for (std::size_t i = 0; 2 * i + 1 < ticks.size(); ++i) {
        const double ms = double(ticks[2 * i + 1] - ticks[2 * i]) * device_.timestamp_period_ns() * 1e-6;
        const auto same =
            std::find_if(times.begin(), times.end(), [&](const PassTime& t) { return t.name == scopes_[i]; });
        if (same == times.end()) {
            times.push_back({scopes_[i], ms});
        } else {
            same->time_ms += ms;
        }
    }
    return times;
}

void Recorder::make_visible_to_host() {
    const vk::MemoryBarrier2 to_host{.srcStageMask = Stage::eAllCommands,
                                     .srcAccessMask = AccessBit::eMemoryWrite,
                                     .dstStageMask = Stage::eHost,
                                     .dstAccessMask = AccessBit::eHostRead};
    commands_.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &to_host}, dispatch());
}

void Recorder::on_host(std::function<bool()> step) { add_step(std::move(step)); }

void Recorder::end_of_steps() { add_step({}); }

void Recorder::add_step(std::function<bool()> step) {
    if (callers_) throw std::logic_error("a step on the host, in commands of the caller's");
    // Mesa's software driver requires a label to end in the command buffer in which it begins.
    if (in_scope_) end_label();
    make_visible_to_host();
    commands_.end(dispatch());
    parts_.push_back({commands_, std::move(step)});
    for (auto& [id, state] : states_) state = {{}, {}, std::move(state.holder)};
    begin_commands();
    if (in_scope_) begin_label();
}

const std::vector<Recorder::Part>& Recorder::end(vk::Event done) {
    make_visible_to_host();
    const vk::MemoryBarrier2 all{.srcStageMask = Stage::eAllCommands, .dstStageMask = Stage::eAllCommands};
    if (done) commands_.setEvent2(done, {.memoryBarrierCount = 1, .pMemoryBarriers = &all}, dispatch());
    if (!callers_) commands_.end(dispatch());
    parts_.push_back({commands_, {}});
    return parts_;
}

void Recorder::run_parts(std::span<const Part> parts, const std::function<void(vk::CommandBuffer, bool last)>& submit) {
    bool goes_on = true;
    for (const Part& part : parts) {
        const bool last = &part == &parts.back();
        if (goes_on || last) submit(part.commands, last);
        goes_on = part.step ? goes_on && part.step() : true;
    }
}

std::vector<PassTime> Recorder::finish() {
    std::vector<PassTime> times = read_times();
    uploads_.clear();
    for (const auto& then : when_done_) then();
    restart();
    return times;
}

std::vector<PassTime> Recorder::submit_and_wait() {
    run_parts(end(), [&](vk::CommandBuffer commands, bool) {
        const vk::CommandBufferSubmitInfo info{.commandBuffer = commands};
        device_.submit({.commandBufferInfoCount = 1, .pCommandBufferInfos = &info}, *fence_);
        while (device_.handle().waitForFences(*fence_, true, ~0ull) == vk::Result::eTimeout) {
        }
        device_.handle().resetFences(*fence_);
    });
    return finish();
}

}  // namespace pellucid
