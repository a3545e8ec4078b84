#include "render/frame_queue.h"

namespace pellucid {
namespace {

std::vector<vk::SemaphoreSubmitInfo> infos_of(const std::vector<vulkan::SemaphoreValue>& semaphores) {
    std::vector<vk::SemaphoreSubmitInfo> infos;
    for (const auto& [semaphore, value] : semaphores) {
        infos.push_back(
            {.semaphore = semaphore, .value = value, .stageMask = vk::PipelineStageFlagBits2::eAllCommands});
    }
    return infos;
}

void wait_for(const Device& device, vk::Fence fence) {
    while (device.handle().waitForFences(fence, true, ~0ull) == vk::Result::eTimeout) {
    }
}

}  // namespace

FrameQueue::~FrameQueue() {
    {
        const std::lock_guard lock(mutex_);
        stops_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void FrameQueue::submit_part(const FrameRun& run, vk::CommandBuffer commands, bool first, bool last, vk::Fence fence) {
    const auto waits = first ? infos_of(run.wait) : std::vector<vk::SemaphoreSubmitInfo>();
    const auto signals = last ? infos_of(run.signal) : std::vector<vk::SemaphoreSubmitInfo>();
    const vk::CommandBufferSubmitInfo info{.commandBuffer = commands};
    device_.submit({.waitSemaphoreInfoCount = std::uint32_t(waits.size()),
                    .pWaitSemaphoreInfos = waits.data(),
                    .commandBufferInfoCount = commands ? 1u : 0u,
                    .pCommandBufferInfos = &info,
                    .signalSemaphoreInfoCount = std::uint32_t(signals.size()),
                    .pSignalSemaphoreInfos = signals.data()},
                   fence);
}

void FrameQueue::submit(FrameRun& run) {
    device_.handle().resetFences(*run.fence);
    run.submitted = run.fenced = false;
    run.failure = nullptr;
    std::unique_lock lock(mutex_);
    if (run.parts.size() == 1 && waiting_.empty()) {
        submit_part(run, run.parts.front().commands, true, true, *run.fence);
        run.submitted = run.fenced = true;
        return;
    }
    waiting_.push_back(&run);
    if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
    lock.unlock();
    changed_.notify_all();
}

void FrameQueue::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [&] { return stops_ || !waiting_.empty(); });
        if (waiting_.empty()) return;
        FrameRun& run = *waiting_.front();
        lock.unlock();
        run_all(run);
        lock.lock();
        run.submitted = true;
        waiting_.pop_front();
        changed_.notify_all();
    }
}

void FrameQueue::run_all(FrameRun& run) {
    bool first = true;
    try {
        const vk::raii::Fence between = device_.handle().createFence({});
        Recorder::run_parts(run.parts, [&](vk::CommandBuffer commands, bool last) {
            submit_part(run, commands, first, last, last ? *run.fence : *between);
            first = false;
            run.fenced = last;
            if (last) return;
            wait_for(device_, *between);
            device_.handle().resetFences(*between);
        });
    } catch (...) {
        run.failure = std::current_exception();
    }
    if (run.fenced) return;
    try {
        submit_part(run, {}, first, true, *run.fence);  // release all waiters for the frame
        run.fenced = true;
    } catch (...) {
        run.failure = std::current_exception();
    }
}

bool FrameQueue::has_run(FrameRun& run) {
    {
        const std::lock_guard lock(mutex_);
        if (!run.submitted) return false;
    }
    return !run.fenced || run.fence.getStatus() == vk::Result::eSuccess;
}

void FrameQueue::wait(FrameRun& run) {
    {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return run.submitted; });
    }
    if (run.fenced) wait_for(device_, *run.fence);
}

}  // namespace pellucid
