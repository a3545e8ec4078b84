#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

namespace pellucid {

/// A file descriptor, closed at the end.
class Descriptor {
public:
    explicit Descriptor(int number = -1) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    ~Descriptor();
    int get() const { return number_; }

private:
    int number_;
};

enum class ApartResult : std::uint32_t { kDone, kRefused, kOutOfMemory };

/// What a request and a reply begin with. The name of the current folder and `size` bytes follow.
struct ApartHead {
    std::uint64_t most_bytes, folder_size, size;
};
struct ApartReply {
    ApartResult result;
    std::uint64_t size;
};
inline constexpr std::uint64_t kApartSlack = std::uint64_t(1) << 20;  ///< of a reply, beside the result's own memory
inline constexpr int kReaderSocket = 3;                               ///< descriptor in the program that reads

/// Two connected sockets of this machine, which programs do not inherit. Throws Error.
std::pair<Descriptor, Descriptor> socket_pair(int type);
/// All `size` bytes; false if the other side has gone.
bool write_all(int socket, const void* data, std::size_t size);
bool read_all(int socket, void* data, std::size_t size);
/// A descriptor with a number. False if the other side has gone.
bool send_descriptor(int socket, int descriptor, std::uint8_t number);
/// Of get() -1 if the other side has gone.
Descriptor receive_descriptor(int socket, std::uint8_t& number);

}  // namespace pellucid
