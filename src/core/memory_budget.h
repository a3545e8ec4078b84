#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>

namespace pellucid {

/// Bytes that one scene may take while it is read: half of the machine's memory, or of what a control group leaves of
/// it. PELLUCID_MEMORY_SHARE (above 0, up to 100) is another share. Throws Error if it is no such number.
std::uint64_t scene_memory();

/// What is left of scene_memory() for one scene. Readers take what they are about to allocate.
class MemoryBudget {
public:
    explicit MemoryBudget(std::filesystem::path scene);

    /// Throws Error naming the scene if it has taken too much. May be called by several threads.
    void take(std::uint64_t bytes);
    /// `count` elements of `size` bytes each, without overflow.
    void take(std::uint64_t count, std::uint64_t size);
    std::uint64_t left() const;
    /// Throws the Error of take() again if one was thrown.
    void check() const;

private:
    std::filesystem::path scene_;
    std::uint64_t limit_;
    std::atomic<std::uint64_t> taken_{0};
    std::atomic<bool> exceeded_{false};
};

}  // namespace pellucid
