#include "core/pipes.h"

#include <pellucid/error.h>

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

namespace pellucid {
namespace {

/// A message of one byte with space for one descriptor.
struct DescriptorMessage {
    DescriptorMessage() {
        header.msg_iov = &part;
        header.msg_iovlen = 1;
        header.msg_control = control.data();
        header.msg_controllen = control.size();
    }

    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
    std::uint8_t number = 0;
    iovec part{.iov_base = &number, .iov_len = 1};
    msghdr header{};
};

}  // namespace

Descriptor::~Descriptor() {
    if (number_ >= 0) close(number_);
}

std::pair<Descriptor, Descriptor> socket_pair(int type) {
    std::array<int, 2> sockets{};
    if (socketpair(AF_UNIX, type | SOCK_CLOEXEC, 0, sockets.data()) != 0)
        throw Error(std::string("cannot make a socket: ") + std::strerror(errno));
    return {Descriptor(sockets[0]), Descriptor(sockets[1])};
}

bool write_all(int socket, const void* data, std::size_t size) {
    const auto* at = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t count = send(socket, at, size, MSG_NOSIGNAL);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        at += count;
        size -= std::size_t(count);
    }
    return true;
}

bool read_all(int socket, void* data, std::size_t size) {
    auto* at = static_cast<char*>(data);
    while (size > 0) {
        const ssize_t count = recv(socket, at, size, 0);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        at += count;
        size -= std::size_t(count);
    }
    return true;
}

bool send_descriptor(int socket, int descriptor, std::uint8_t number) {
    DescriptorMessage message;
    message.number = number;
    cmsghdr* const part = CMSG_FIRSTHDR(&message.header);
    part->cmsg_level = SOL_SOCKET;
    part->cmsg_type = SCM_RIGHTS;
    part->cmsg_len = CMSG_LEN(sizeof descriptor);
    std::memcpy(CMSG_DATA(part), &descriptor, sizeof descriptor);
    ssize_t count = 0;
    do count = sendmsg(socket, &message.header, MSG_NOSIGNAL);
    while (count < 0 && errno == EINTR);
    return count == 1;
}

Descriptor receive_descriptor(int socket, std::uint8_t& number) {
    DescriptorMessage message;
    ssize_t count = 0;
    do count = recvmsg(socket, &message.header, MSG_CMSG_CLOEXEC);
    while (count < 0 && errno == EINTR);
    const cmsghdr* const part = count == 1 ? CMSG_FIRSTHDR(&message.header) : nullptr;
    if (!part || part->cmsg_type != SCM_RIGHTS) return Descriptor();
    number = message.number;
    int descriptor = -1;
    std::memcpy(&descriptor, CMSG_DATA(part), sizeof descriptor);
    return Descriptor(descriptor);
}

}  // namespace pellucid
