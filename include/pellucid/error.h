#pragma once

#include <pellucid/api.h>

#include <stdexcept>
#include <string>
#include <string_view>

namespace pellucid {

/// Bad input: an unusable file, name or value. `what()` is one line that names the file, the element or line if any,
/// and the cause. Programs print it and exit 2.
class PELLUCID_API Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// No Vulkan device offers the features that Pellucid needs; `what()` lists the missing features. Programs exit 3.
class PELLUCID_API DeviceError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Replaces every run of white space and control characters in `text` by one blank. Names in files may contain line
/// breaks, but messages are one line.
PELLUCID_API std::string one_line(std::string_view text);

}  // namespace pellucid
