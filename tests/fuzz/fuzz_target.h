#pragma once

#include "unit/test_files.h"

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace pellucid::test {

/// A reader and the kind of file that is fed to it.
struct FuzzTarget {
    std::string_view name;
    std::string_view file;             ///< name that the bytes are stored by
    void (*read)(const std::string&);  ///< throws Error for a file that it refuses; other exceptions are bugs
};

std::span<const FuzzTarget> reader_targets();
/// Command lines: an argument is a line of the file. They are parsed, but no command runs.
std::span<const FuzzTarget> command_targets();

/// Stores `bytes` in a temporary folder and reads them. What the reader refuses with an Error of one line is fine;
/// every other failure throws another exception, or crashes.
inline void run_fuzz_target(const FuzzTarget& target, std::string_view bytes) {
    static const TemporaryFolder folder;
    const std::string file = folder.file(std::string(target.file), bytes);
    try {
        target.read(file);
    } catch (const Error& error) {
        if (std::string_view(error.what()).find('\n') != std::string_view::npos)
            throw std::logic_error("an error has two lines");
    }
}

}  // namespace pellucid::test
