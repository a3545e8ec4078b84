#include "sequence/frames.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <system_error>

namespace pellucid::sequence {
namespace {

constexpr long kMostFrames = 10'000'000;

/// A whole number from 0 that is all of `text`; -1 otherwise.
long number_of(std::string_view text) {
    long number = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() && number < kMostFrames ? number : -1;
}

}  // namespace

Frames parse_frames(const std::string& what, const std::string& text) {
    Frames frames;
    std::string_view rest = text;
    for (bool more = true; more;) {
        const std::size_t comma = rest.find(',');
        const std::string_view part = rest.substr(0, comma);
        more = comma != std::string_view::npos;
        if (more) rest.remove_prefix(comma + 1);
        const std::size_t dots = part.find("..");
        const long first = number_of(part.substr(0, dots));
        const long last = dots == std::string_view::npos ? first : number_of(part.substr(dots + 2));
        if (first < 0 || last < first)
            throw Error(fmt::format("{}: '{}' should be A..B, with whole numbers from 0 to {}, or several with commas",
                                    what, part, kMostFrames - 1));
        for (long frame = first; frame <= last; ++frame) frames.push_back(frame);
    }
    std::sort(frames.begin(), frames.end());
    frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
    return frames;
}

std::string format_frames(const Frames& frames) {
    std::string text;
    for (std::size_t i = 0; i < frames.size();) {
        std::size_t end = i + 1;
        while (end < frames.size() && frames[end] == frames[end - 1] + 1) ++end;
        text += fmt::format("{}{}", text.empty() ? "" : ",", frames[i]);
        if (end - i > 1) text += fmt::format("..{}", frames[end - 1]);
        i = end;
    }
    return text;
}

std::vector<Frames> split_frames(const Frames& frames, std::size_t tasks) {
    tasks = std::min(tasks, frames.size());
    std::vector<Frames> parts;
    for (std::size_t i = 0; i < tasks; ++i) {
        const auto begin = frames.begin() + long(frames.size() * i / tasks);
        const auto end = frames.begin() + long(frames.size() * (i + 1) / tasks);
        parts.emplace_back(begin, end);
    }
    return parts;
}

FilePattern::FilePattern(const std::string& what, const std::string& pattern) {
    const std::filesystem::path path = pattern;
    const std::string name = path.filename().string();
    const std::size_t begin = name.find('#');
    const std::size_t end = std::min(name.find_first_not_of('#', begin), name.size());
    if (begin == std::string::npos || name.find('#', end) != std::string::npos)
        throw Error(fmt::format("{}: '{}' should have one run of # for the number, as frame-####.png", what, pattern));
    folder_ = path.parent_path();
    before_ = name.substr(0, begin);
    after_ = name.substr(end);
    digits_ = end - begin;
}

std::filesystem::path FilePattern::file(long frame) const {
    return folder_ / fmt::format("{}{:0{}}{}", before_, frame, digits_, after_);
}

std::filesystem::path FilePattern::beside(const std::string& word, const std::string& extension) const {
    return folder_ / std::filesystem::path(before_ + word + after_).replace_extension(extension);
}

bool is_written(const std::filesystem::path& file) {
    std::error_code error;
    return std::filesystem::is_regular_file(file, error);
}

}  // namespace pellucid::sequence
