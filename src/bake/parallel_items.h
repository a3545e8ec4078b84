#pragma once

#include <pellucid/progress.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>
#include <cstdint>
#include <mutex>

namespace pellucid::bake {

/// Calls item(i) for i in 0..count-1, on `threads` threads (0: all cores), and reports progress.
template <class Item>
void for_each_item(std::size_t count, std::uint32_t threads, const Progress& progress, const Item& item) {
    std::mutex mutex;
    std::size_t done = 0;
    tbb::task_arena arena(threads > 0 ? int(threads) : tbb::task_arena::automatic);
    arena.execute([&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) item(i);
            if (!progress) return;
            const std::lock_guard lock(mutex);
            done += range.size();
            progress(double(done) / double(count));
        });
    });
}

}  // namespace pellucid::bake
