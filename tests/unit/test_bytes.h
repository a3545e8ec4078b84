#pragma once

#include <algorithm>
#include <cstring>
#include <string>

namespace pellucid::test {

/// Appends the bytes of a number, as binary files store it.
template <class T>
void append(std::string& bytes, T value, bool big_endian = false) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (big_endian) std::reverse(raw, raw + sizeof(T));
    bytes.append(raw, sizeof(T));
}

}  // namespace pellucid::test
