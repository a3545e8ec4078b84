#pragma once

#include <functional>

namespace pellucid {

/// Called now and then during long work with the share that is done, 0..1, never twice at a time.
/// Empty: nobody listens.
using Progress = std::function<void(double share)>;

}  // namespace pellucid
