#include "core/file.h"

#include "core/fail.h"

#include <pellucid/error.h>

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <system_error>

namespace pellucid {
namespace {

std::filesystem::path temporary_beside(const std::filesystem::path& file) {
    // The process id separates programs, the counter separates threads of one program.
    static std::atomic<unsigned> counter{0};
    std::filesystem::path name = ".";
    name += file.stem();
    name += ".part-" + std::to_string(getpid()) + "-" + std::to_string(counter++);
    name += file.extension();
    return file.parent_path() / name;
}

/// Target of a symbolic link; a dangling link is its own target.
std::filesystem::path link_target(const std::filesystem::path& link) {
    std::error_code error;
    const std::filesystem::path target = std::filesystem::weakly_canonical(link, error);
    if (error) fail(link, "cannot write: " + error.message());
    check_writable(target);
    return target;
}

}  // namespace

std::uintmax_t check_readable(const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found) fail(file, "no such file");
    if (error) fail(file, error.message());
    if (std::filesystem::is_directory(status)) fail(file, "is a folder, not a file");
    // A pipe would block and a device may never end.
    if (!std::filesystem::is_regular_file(status)) fail(file, "is not a regular file");
    if (access(file.c_str(), R_OK) != 0) fail(file, std::strerror(errno));
    const auto size = std::filesystem::file_size(file, error);
    if (error) fail(file, error.message());
    return size;
}

std::vector<std::byte> read_file(const std::filesystem::path& file) {
    std::vector<std::byte> bytes(check_readable(file));
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), &std::fclose);
    if (!stream) fail(file, std::strerror(errno));
    if (std::fread(bytes.data(), 1, bytes.size(), stream.get()) != bytes.size())
        fail(file, "cannot be read completely");
    return bytes;
}

std::vector<std::byte> first_bytes(const std::filesystem::path& file, std::size_t count) {
    std::vector<std::byte> bytes(count);
    std::ifstream stream(file, std::ios::binary);
    stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
    bytes.resize(std::size_t(stream.gcount()));
    return bytes;
}

// Reports exact causes, where libraries that write would only report "could not open".
void check_writable(const std::filesystem::path& file) {
    if (!file.has_filename()) fail(file, "names no file");
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (std::filesystem::is_directory(status)) fail(file, "cannot write: is a folder");
    // Renaming onto /dev/null or a pipe would replace it.
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        fail(file, "cannot write: is not a regular file");
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    if (!std::filesystem::exists(folder, error)) fail(file, "cannot write: there is no folder " + folder.string());
    if (!std::filesystem::is_directory(folder, error))
        fail(file, "cannot write: " + folder.string() + " is not a folder");
    if (access(folder.c_str(), W_OK | X_OK) != 0)
        fail(file, "cannot write into folder " + folder.string() + ": " + std::strerror(errno));
}

void write_file_atomically(const std::filesystem::path& file,
                           const std::function<void(const std::filesystem::path& temporary)>& write) {
    check_writable(file);
    std::error_code no_link;
    const std::filesystem::path target = std::filesystem::is_symlink(file, no_link) ? link_target(file) : file;
    const std::filesystem::path temporary = temporary_beside(target);
    std::error_code ignored;
    try {
        write(temporary);
        std::error_code error;
        std::filesystem::rename(temporary, target, error);
        if (error) fail(file, "cannot write: " + error.message());
    } catch (const Error&) {
        std::filesystem::remove(temporary, ignored);
        throw;
    } catch (const std::exception& cause) {
        std::filesystem::remove(temporary, ignored);
        fail(file, std::string("cannot write: ") + cause.what());
    }
}

void write_text_file(const std::filesystem::path& file, std::string_view text) {
    write_file_atomically(file, [&](const std::filesystem::path& temporary) {
        std::ofstream stream(temporary, std::ios::binary);
        stream.write(text.data(), static_cast<std::streamsize>(text.size()));
        stream.close();
        if (!stream) fail(file, std::string("cannot write: ") + std::strerror(errno));
    });
}

}  // namespace pellucid
