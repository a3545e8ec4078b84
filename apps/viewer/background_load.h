#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <string>
#include <thread>
#include <utility>

namespace pellucid::viewer {

/// Loads one value at a time on its own thread. A replaced or cancelled load runs to its end and is discarded, because
/// reading a file cannot be interrupted. `load` must therefore not refer to objects that may be destroyed before it
/// ends.
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
    /// The name given to start().
    const std::string& name() const { return name_; }
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
    /// True if the load has ended.
    bool ready() const { return busy() && value_.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }
    /// Returns the value of a load that is ready(), or throws the exception of `load`.
    Value take() { return std::exchange(value_, {}).get(); }

private:
    std::string name_;
    std::future<Value> value_;
    std::chrono::steady_clock::time_point start_;
};

}  // namespace pellucid::viewer
