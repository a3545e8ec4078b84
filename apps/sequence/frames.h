#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace pellucid::sequence {

/// Numbers of frames, from 0, in rising order and each once.
using Frames = std::vector<long>;

/// Parses "A..B,C,...", both ends included. Throws Error naming `what`.
Frames parse_frames(const std::string& what, const std::string& text);
/// The shortest text that parse_frames() takes for `frames`.
std::string format_frames(const Frames& frames);

/// Splits `frames` into `tasks` runs of neighbours, whose lengths differ by one at most; fewer where there are fewer frames.
std::vector<Frames> split_frames(const Frames& frames, std::size_t tasks);

/// A file name with a run of #, such as "frame-####.png", that stands for the number of the frame.
class FilePattern {
public:
    /// Throws Error naming `what` if the file name has no # or several runs of them.
    FilePattern(const std::string& what, const std::string& pattern);

    /// The frame's file: its number has at least as many digits as the pattern has #.
    std::filesystem::path file(long frame) const;
    /// A file beside the frames that belongs to all of them: the pattern's # are a word, such as "lock".
    std::filesystem::path beside(const std::string& word, const std::string& extension) const;

private:
    std::filesystem::path folder_;
    std::string before_, after_;  ///< the number
    std::size_t digits_ = 0;
};

/// Whether the frame has been written: files appear complete or not at all.
bool is_written(const std::filesystem::path& file);

}  // namespace pellucid::sequence
