#pragma once

#include "gpu/recorder.h"

#include <pellucid/vulkan.h>

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace pellucid {

/// A frame on its way through the device.
struct FrameRun {
    explicit FrameRun(const Device& device) : fence(device.handle().createFence({})) {}
    std::vector<Recorder::Part> parts;
    std::vector<vulkan::SemaphoreValue> wait, signal;
    vk::raii::Fence fence;
    bool submitted = false;  ///< all of it; of the FrameQueue
    std::exception_ptr failure;
};

/// Submits frames one after the other, and does not wait. Where the host has a part in one, a thread sees to it, and to the
/// frames behind.
class FrameQueue {
public:
    explicit FrameQueue(const Device& device) : device_(device) {}
    /// Finishes all frames.
    ~FrameQueue();
    FrameQueue(const FrameQueue&) = delete;
    FrameQueue& operator=(const FrameQueue&) = delete;

    /// `run` lives until it has run.
    void submit(FrameRun& run);
    /// FrameRun::failure is then what went wrong in it.
    bool has_run(FrameRun& run);
    void wait(FrameRun& run);

private:
    void work();
    void run_all(FrameRun& run);
    void submit_part(const FrameRun& run, vk::CommandBuffer commands, bool first, bool last, vk::Fence fence);

    const Device& device_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<FrameRun*> waiting_;  ///< the first is being run
    bool stops_ = false;
    std::thread thread_;  ///< started by the first frame that needs it
};

}  // namespace pellucid
