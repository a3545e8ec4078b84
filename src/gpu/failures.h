#pragma once

#include "gpu/vulkan.h"

namespace pellucid {

/// Throws the error that says in one line what a failed call of Vulkan means for the caller: Error for lack of memory,
/// DeviceError if the device is lost or fails otherwise.
[[noreturn]] void throw_clearly(const vk::SystemError& failure);

}  // namespace pellucid
