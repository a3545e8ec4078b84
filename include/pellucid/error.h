#pragma once

#include <pellucid/api.h>

#include <stdexcept>
#include <string>
#include <string_view>

namespace pellucid {

/// Bad input: a file, a name or a value that cannot be used. `what()` is one line that names the
/// file (and, where there is one, the element or line) and the cause. Programs print it and exit 2.
class PELLUCID_API Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// No Vulkan device offers what Pellucid needs; `what()` says what is missing. Programs exit 3.
class PELLUCID_API DeviceError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// `text` with every run of white space and control characters as one blank. Names inside of files may hold line
/// breaks; messages are one line.
PELLUCID_API std::string one_line(std::string_view text);

}  // namespace pellucid
