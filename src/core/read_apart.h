#pragma once

#include "core/pipes.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace pellucid {

/// What is read by libraries that were not written for hostile files.
enum class ApartKind : std::uint8_t { kImage, k3ds, kVdb };

/// Reads one file: bytes of a request in, bytes of the result out. Throws an exception for a file that is refused.
using ApartReader = std::vector<std::byte> (*)(std::span<const std::byte> request);

/// A program that calls readers in a process for each file. A crash, a hang and a lack of memory end that process only.
/// It starts with the first file and ends with this process.
class ReaderProgram {
public:
    explicit ReaderProgram(std::filesystem::path program) : program_(std::move(program)) {}

    /// `most_bytes`: memory for the result. Throws Error with the reader's message, or naming `file` if there is no
    /// result. May be called by several threads.
    std::vector<std::byte> read(ApartKind kind, std::span<const std::byte> request, std::uint64_t most_bytes,
                                const std::filesystem::path& file);

private:
    Descriptor connect(ApartKind kind);
    Descriptor start() const;

    std::filesystem::path program_;
    std::mutex mutex_;
    Descriptor control_;
};

/// ReaderProgram::read() of `pellucid-reader`, which lies beside the library and has all readers.
/// PELLUCID_READ_APART=0: `reader` is called in this process instead.
std::vector<std::byte> read_apart(ApartKind kind, ApartReader reader, std::span<const std::byte> request,
                                  std::uint64_t most_bytes, const std::filesystem::path& file);

/// A reader as such a program has it.
struct ServedReader {
    ApartReader read;
    void (*prepare)() = nullptr;  ///< once, before the first file: loads what all files need, and starts no thread
};

/// The main function of such a program. `readers`: by their kind.
[[noreturn]] void serve_readers(std::span<const ServedReader> readers);

/// Folder of the library or program that holds this code.
std::filesystem::path own_folder();

}  // namespace pellucid
