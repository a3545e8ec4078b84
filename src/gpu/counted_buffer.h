#pragma once

#include "gpu/recorder.h"
#include "gpu/workspace.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace pellucid {

/// A storage buffer that shaders append to: they count every item, and write the items that fit. Where a frame counts
/// more than fit, it must be recorded again, and then they do.
///
/// The buffer begins with four uints, of which shaders count in the first, and in the second if they need more items than
/// they append. Shaders take the capacity from the length of their array.
class CountedBuffer {
public:
    /// `name`: of the items, plural. `texels`, `host_visible`: as of Workspace::buffer().
    CountedBuffer(std::string name, vk::DeviceSize item_size, vk::Format texels = vk::Format::eUndefined,
                  bool host_visible = false)
        : name_(std::move(name)), item_size_(item_size), texels_(texels), host_visible_(host_visible) {}

    /// An empty buffer, for `guess` items where no capacity is set. Throws TooLarge if the device allows no
    /// buffer of that capacity.
    const Buffer& begin(Recorder& recorder, Workspace& workspace, std::uint64_t guess);
    /// Reads the number of items after the passes that append; `then` gets it once the frame has run.
    void end(Recorder& recorder, std::function<void(std::uint32_t)> then = {});
    /// Arguments of Recorder::compute_indirect() for shaders that take an item per invocation, in workgroups of 64.
    const Buffer& groups(Recorder& recorder, Workspace& workspace) const;

    /// After the frame has run: true if items did not fit. The capacity is then a quarter more than they need.
    bool grow();
    const std::string& name() const { return name_; }

    const Buffer& buffer() const { return *buffer_; }     ///< begun in this frame
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
    /// The most items since the last grow(); shared with frames that run.
    std::shared_ptr<std::uint32_t> counted_ = std::make_shared<std::uint32_t>(0);
    const Buffer* buffer_ = nullptr;  ///< of this frame
};

}  // namespace pellucid
