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

/// A frame in the queue.
struct FrameRun {
    explicit FrameRun(const Device& device) : fence(device.handle().createFence({})) {}
    std::vector<Recorder::Part> parts;
    std::vector<vulkan::SemaphoreValue> wait, signal;
    vk::raii::Fence fence;
    bool submitted = false;  ///< all parts submitted; guarded by FrameQueue
    bool fenced = false;     ///< the fence will be signalled; false if the last submission failed
    std::exception_ptr failure;
};

/// Submits frames in order, without waiting. If the host has a part in a frame, a thread runs that frame and all
/// frames behind it.
class FrameQueue {
public:
    explicit FrameQueue(const Device& device) : device_(device) {}
    /// Finishes all frames.
    ~FrameQueue();
    FrameQueue(const FrameQueue&) = delete;
    FrameQueue& operator=(const FrameQueue&) = delete;

    /// Submits a frame. `run` must live until the frame has run.
    void submit(FrameRun& run);
    /// True once the frame has run or failed. FrameRun::failure then contains its error, if any.
    bool has_run(FrameRun& run);
    void wait(FrameRun& run);

private:
    void work();
    void run_all(FrameRun& run);
    void submit_part(const FrameRun& run, vk::CommandBuffer commands, bool first, bool last, vk::Fence fence);

    const Device& device_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<FrameRun*> waiting_;  ///< the first is running
    bool stops_ = false;
    std::thread thread_;  ///< started by the first frame that needs the thread
};

}  // namespace pellucid
