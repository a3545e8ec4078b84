#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <string>
#include <thread>
#include <utility>

namespace pellucid::viewer {

/// Loads one value at a time on a thread of its own. A load that is replaced or cancelled runs to its end unheard, because
/// files cannot be left half read; therefore `load` must not refer to anything that may end before it.
template <class Value>
class BackgroundLoad {
public:
    void start(std::string name, std::function<Value()> load) {
        std::packaged_task<Value()> task(std::move(load));
        name_ = std::move(name);
        start_ = std::chrono::steady_clock::now();
        value_ = task.get_future();
        std::thread(std::move(task)).detach();
    }
    void cancel() { value_ = {}; }
    bool busy() const { return value_.valid(); }
    /// As given to start().
    const std::string& name() const { return name_; }
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
    /// The load has ended.
    bool ready() const { return busy() && value_.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }
    /// The value of a load that is ready(). Throws what `load` has thrown.
    Value take() { return std::exchange(value_, {}).get(); }

private:
    std::string name_;
    std::future<Value> value_;
    std::chrono::steady_clock::time_point start_;
};

}  // namespace pellucid::viewer
