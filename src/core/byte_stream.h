#pragma once

#include <pellucid/error.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace pellucid {

/// Values one after the other, for another process on this machine.
class ByteWriter {
public:
    template <class T>
    void value(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        append(&value, sizeof value);
    }
    template <class Values>
    void values(const Values& values) {
        using T = std::remove_cvref_t<decltype(*values.data())>;
        static_assert(std::is_trivially_copyable_v<T>);
        value(std::uint64_t(values.size()));
        append(values.data(), values.size() * sizeof(T));
    }
    void text(const std::string& text) {
        value(std::uint64_t(text.size()));
        append(text.data(), text.size());
    }
    std::vector<std::byte> take() { return std::move(bytes_); }

private:
    void append(const void* data, std::size_t size) {
        const auto* const begin = static_cast<const std::byte*>(data);
        bytes_.insert(bytes_.end(), begin, begin + size);
    }

    std::vector<std::byte> bytes_;
};

/// Takes them apart. Throws Error where there are too few bytes.
class [[gnu::visibility("hidden")]] ByteReader {  // also in vdb_file.cpp
public:
    explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    template <class T>
    T value() {
        static_assert(std::is_trivially_copyable_v<T>);
        T value;
        std::memcpy(&value, next(1, sizeof value), sizeof value);
        return value;
    }
    template <class T>
    std::vector<T> values() {
        static_assert(std::is_trivially_copyable_v<T>);
        const auto count = value<std::uint64_t>();
        const std::byte* const at = next(count, sizeof(T));
        std::vector<T> values(count);
        if (count > 0) std::memcpy(values.data(), at, count * sizeof(T));
        return values;
    }
    std::string text() {
        const auto size = value<std::uint64_t>();
        const std::byte* const at = next(size, 1);
        return {reinterpret_cast<const char*>(at), size};
    }

private:
    const std::byte* next(std::uint64_t count, std::size_t size) {
        if (count > (bytes_.size() - at_) / size) throw Error("a message of the reader is incomplete");
        const std::byte* const begin = bytes_.data() + at_;
        at_ += count * size;
        return begin;
    }

    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
};

}  // namespace pellucid
