#pragma once

#include "gpu/recorder.h"
#include "gpu/workspace.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace pellucid {

/// A storage buffer to which shaders append items. They count every item, but write only the items that fit. If a frame
/// counts more items than fit, the buffer grows, and the frame must be recorded again.
///
/// The buffer begins with four uints. The first counts appended items. Shaders that need more items than they append
/// count those in the second. Shaders get the capacity from the length of their array.
class CountedBuffer {
public:
    /// `name`: name of the items, plural. `texels`, `host_visible`: as in Workspace::buffer().
    CountedBuffer(std::string name, vk::DeviceSize item_size, vk::Format texels = vk::Format::eUndefined,
                  bool host_visible = false)
        : name_(std::move(name)), item_size_(item_size), texels_(texels), host_visible_(host_visible) {}

    /// Returns the buffer, emptied. Its capacity is `guess` items if none is set. Throws TooLarge if the device allows
    /// no buffer of that capacity.
    const Buffer& begin(Recorder& recorder, Workspace& workspace, std::uint64_t guess);
    /// Call after the passes that append. Reads back the number of items; `then` gets it once the frame has run.
    void end(Recorder& recorder, std::function<void(std::uint32_t)> then = {});
    /// Arguments of Recorder::compute_indirect() for shaders with one invocation per item, in workgroups of 64.
    const Buffer& groups(Recorder& recorder, Workspace& workspace) const;

    /// Call after the frame has run. True if items did not fit; the capacity is then a quarter more than needed.
    bool grow();
    const std::string& name() const { return name_; }

    const Buffer& buffer() const { return *buffer_; }     ///< as returned by begin() in this frame
    std::uint32_t capacity() const { return capacity_; }  ///< items; 0: not set
    void set_capacity(std::uint64_t items) { capacity_ = std::uint32_t(items); }
    /// The largest capacity that the device allows.
    std::uint32_t limit(const Device& device) const;

private:
    std::string name_;
    vk::DeviceSize item_size_;
    vk::Format texels_;
    bool host_visible_;
    std::uint32_t capacity_ = 0, limit_ = 0;
    /// Largest item count since the last grow(); shared with running frames.
    std::shared_ptr<std::uint32_t> counted_ = std::make_shared<std::uint32_t>(0);
    const Buffer* buffer_ = nullptr;  ///< of this frame
};

}  // namespace pellucid
