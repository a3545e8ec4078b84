#pragma once

#include <stdexcept>
#include <string>

namespace pellucid {

/// Bad input: a file, a name or a value that cannot be used. `what()` is one line that names the
/// file (and, where there is one, the element or line) and the cause. Programs print it and exit 2.
class Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// No Vulkan device offers what Pellucid needs; `what()` says what is missing. Programs exit 3.
class DeviceError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace pellucid
