#pragma once

#include <atomic>
#include <cstdint>
#include <limits>

namespace pellucid::test {

/// Calls of Vulkan counted so far, and which fail; see failing_layer.cpp.
struct Failures {
    static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

    std::atomic<std::uint64_t> allocations{0}, objects{0}, submissions{0};
    /// Number of the first call that fails, from 1; all later ones fail too.
    std::atomic<std::uint64_t> first_allocation{kNever}, first_object{kNever}, first_submission{kNever};
    std::atomic<std::int64_t> live{0};      ///< allocations that have not been freed
    std::atomic<bool> lose_in_wait{false};  ///< the next wait for a fence loses the device
};

}  // namespace pellucid::test
