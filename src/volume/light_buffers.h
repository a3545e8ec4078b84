#pragma once

#include "gpu/memory.h"

#include <algorithm>
#include <span>
#include <vector>

namespace pellucid {

/// Usage of the buffers of light tracing.
inline constexpr vk::BufferUsageFlags kStorage =
    vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst |
    vk::BufferUsageFlagBits::eTransferSrc | vk::BufferUsageFlagBits::eIndirectBuffer;

/// A buffer with these values; one undefined value if there are none.
template <class T>
Buffer filled(const Device& device, const char* name, const std::vector<T>& values) {
    Buffer buffer(device, name, std::max<std::size_t>(1, values.size()) * sizeof(T), kStorage);
    upload(device, buffer, std::as_bytes(std::span(values)));
    return buffer;
}

}  // namespace pellucid
