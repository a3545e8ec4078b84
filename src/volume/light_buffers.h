#pragma once

#include "gpu/memory.h"

#include <algorithm>
#include <span>
#include <vector>

namespace pellucid {

/// Of what the tracing of light keeps.
inline constexpr vk::BufferUsageFlags kStorage =
    vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst |
    vk::BufferUsageFlagBits::eTransferSrc | vk::BufferUsageFlagBits::eIndirectBuffer;

/// A buffer of these values, or of one that is undefined where there are none.
template <class T>
Buffer filled(const Device& device, const char* name, const std::vector<T>& values) {
    Buffer buffer(device, name, std::max<std::size_t>(1, values.size()) * sizeof(T), kStorage);
    upload(device, buffer, std::as_bytes(std::span(values)));
    return buffer;
}

}  // namespace pellucid
