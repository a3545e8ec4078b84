#include "core/memory_budget.h"

#include "core/fail.h"

#include <unistd.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <utility>

namespace pellucid {
namespace {

constexpr const char* kVariable = "PELLUCID_MEMORY_SHARE";
constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

double memory_share() {
    const char* const text = std::getenv(kVariable);
    if (!text || !*text) return 0.5;
    char* end = nullptr;
    const double share = std::strtod(text, &end);
    if (*end != '\0' || !(share > 0.0 && share <= 100.0))
        throw Error(fmt::format("{}={}: must be a number above 0 and up to 100", kVariable, one_line(text)));
    return share;
}

/// Limit of the control group (version 2 or 1) that this process is in.
std::uint64_t group_limit() {
    std::uint64_t limit = kUnlimited;
    for (const char* file : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
        if (std::uint64_t bytes = 0; std::ifstream(file) >> bytes) limit = std::min(limit, bytes);
    return limit;
}

std::uint64_t machine_memory() {
    const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    const std::uint64_t physical = pages > 0 && size > 0 ? std::uint64_t(pages) * std::uint64_t(size) : kUnlimited;
    return std::min(physical, group_limit());
}

}  // namespace

std::uint64_t scene_memory() {
    const double share = memory_share();
    const std::uint64_t memory = machine_memory();
    const double bytes = double(memory) * share;
    return memory == kUnlimited || bytes >= 9e18 ? kUnlimited : std::uint64_t(bytes);
}

MemoryBudget::MemoryBudget(std::filesystem::path scene) : scene_(std::move(scene)), limit_(scene_memory()) {}

void MemoryBudget::take(std::uint64_t bytes) {
    std::uint64_t taken = taken_.load();
    do {
        if (bytes > limit_ - taken) {
            exceeded_ = true;
            check();
        }
    } while (!taken_.compare_exchange_weak(taken, taken + bytes));
}

void MemoryBudget::take(std::uint64_t count, std::uint64_t size) {
    take(size > 0 && count > kUnlimited / size ? kUnlimited : count * size);
}

void MemoryBudget::check() const {
    if (exceeded_)
        fail(scene_, fmt::format("needs more than {:.3g} GiB to load, the share of memory that {} sets (default 0.5)",
                                 double(limit_) / double(1 << 30), kVariable));
}

std::uint64_t MemoryBudget::left() const { return limit_ - taken_.load(); }

}  // namespace pellucid
