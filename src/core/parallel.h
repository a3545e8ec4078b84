#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace pellucid {

/// Calls `item(i)` for i in 0..count-1, on as many threads as there are cores. `item` must not throw.
template <class Item>
void for_each_parallel(std::size_t count, const Item& item) {
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t i = next++; i < count; i = next++) item(i);
    };
    std::vector<std::jthread> threads;
    for (unsigned i = 1; i < std::max(std::thread::hardware_concurrency(), 1u) && i < count; ++i)
        threads.emplace_back(work);
    work();
}

}  // namespace pellucid
