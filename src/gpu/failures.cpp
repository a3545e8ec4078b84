#include "gpu/failures.h"

#include "gpu/memory.h"

#include <fmt/format.h>

namespace pellucid {

void throw_clearly(const vk::SystemError& failure) {
    switch (vk::Result(failure.code().value())) {
        case vk::Result::eErrorDeviceLost:
            throw DeviceError(
                "the Vulkan device was lost: its driver was reset, or a frame took too long. Start again (a program "
                "creates a new Renderer); if it happens again, give a smaller size");
        case vk::Result::eErrorOutOfDeviceMemory:
            throw TooLarge("out of device memory; give a smaller size or a smaller scene");
        case vk::Result::eErrorOutOfHostMemory:
            throw TooLarge("out of memory; give a smaller size or a smaller scene");
        default:
            throw DeviceError(fmt::format("Vulkan failed: {}", failure.what()));
    }
}

}  // namespace pellucid
