#pragma once

#include <functional>

namespace pellucid {

/// Callback during long work, with the finished share, 0..1. Calls never overlap. An empty function is not called.
using Progress = std::function<void(double share)>;

}  // namespace pellucid
