#pragma once

namespace tbb {

namespace detail {
/// Threads of the arena that the caller is in. At least 4, so that threads meet on small machines, too.
inline thread_local int threads_of_arena = 4;
}  // namespace detail

class task_arena {
public:
    static constexpr int automatic = -1;
    explicit task_arena(int threads = automatic) : threads_(threads) {}
    int max_concurrency() const { return threads_ > 0 ? threads_ : 4; }
    template <class Work>
    auto execute(const Work& work) {
        struct Back {
            int threads = detail::threads_of_arena;
            ~Back() { detail::threads_of_arena = threads; }
        } back;
        detail::threads_of_arena = max_concurrency();
        return work();
    }

private:
    int threads_;
};

}  // namespace tbb
