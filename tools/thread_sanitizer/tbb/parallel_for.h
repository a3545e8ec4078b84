#pragma once

// Stands in for oneTBB under the thread sanitizer. TBB comes uninstrumented, so the sanitizer would report everything
// that a loop reads from before it. Threads of the standard library are instrumented.
#include <tbb/blocked_range.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tbb {

/// Calls body(range) for parts of the range, of at most its grain size.
template <class Index, class Body>
void parallel_for(const blocked_range<Index>& range, const Body& body) {
    std::mutex mutex;
    Index next = range.begin();
    std::exception_ptr failure;
    const auto work = [&] {
        for (;;) {
            Index begin, end;
            {
                const std::lock_guard lock(mutex);
                if (failure || next == range.end()) return;
                begin = next;
                end = begin + std::min(Index(range.grainsize()), Index(range.end() - begin));
                next = end;
            }
            try {
                body(blocked_range<Index>(begin, end));
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (!failure) failure = std::current_exception();
            }
        }
    };
    std::vector<std::jthread> others;
    for (int i = 1; i < detail::threads_of_arena; ++i) others.emplace_back(work);
    work();
    others.clear();
    if (failure) std::rethrow_exception(failure);
}

template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
    if (first >= last) return;
    parallel_for(blocked_range<Index>(first, last), [&](const blocked_range<Index>& range) {
        for (Index i = range.begin(); i != range.end(); ++i) body(i);
    });
}

}  // namespace tbb
