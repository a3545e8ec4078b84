#include "sequence/keyed_text.h"

#include "options/arguments.h"
#include "sequence/frames.h"

#include <pellucid/error.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>

namespace pellucid::sequence {

KeyedText::KeyedText(const std::string& what, const std::vector<std::string>& keys) {
    for (const std::string& text : keys) {
        const std::size_t equals = text.find('='), colon = text.find(':');
        if (equals == std::string::npos || colon == std::string::npos || colon < equals)
            throw Error(fmt::format("{}: '{}' should be FRAME=KIND:NUMBERS", what, text));
        const Frames frame = parse_frames(what, text.substr(0, equals));
        const std::string kind = text.substr(equals + 1, colon - equals - 1), numbers = text.substr(colon + 1);
        const auto count = std::size_t(std::count(numbers.begin(), numbers.end(), ',')) + 1;
        if (keys_.empty()) kind_ = kind;
        if (frame.size() != 1 || kind != kind_ || (!keys_.empty() && count != keys_.front().numbers.size()))
            throw Error(
                fmt::format("{}: '{}': keys are of one frame each, of one kind, and have as many numbers", what, text));
        keys_.push_back({frame.front(), cli::parse_numbers(what, numbers, count), std::vector<double>(count)});
    }
    std::sort(keys_.begin(), keys_.end(), [](const Key& a, const Key& b) { return a.frame < b.frame; });
    for (std::size_t i = 1; i < keys_.size(); ++i)
        if (keys_[i].frame == keys_[i - 1].frame)
            throw Error(fmt::format("{}: frame {} has two keys", what, keys_[i].frame));
    find_slopes();
}

// Section 4 of the paper, with the harmonic means that Fritsch and Butland use for the slopes.
void KeyedText::find_slopes() {
    if (keys_.size() < 2) return;
    const auto rise = [this](std::size_t key, std::size_t n) {
        return (keys_[key + 1].numbers[n] - keys_[key].numbers[n]) / double(keys_[key + 1].frame - keys_[key].frame);
    };
    for (std::size_t n = 0; n < keys_.front().numbers.size(); ++n) {
        keys_.front().slopes[n] = rise(0, n);
        keys_.back().slopes[n] = rise(keys_.size() - 2, n);
        for (std::size_t i = 1; i + 1 < keys_.size(); ++i) {
            const double before = rise(i - 1, n), after = rise(i, n);
            if (before * after <= 0.0) continue;
            const auto width_before = double(keys_[i].frame - keys_[i - 1].frame);
            const auto width_after = double(keys_[i + 1].frame - keys_[i].frame);
            const double a = 2.0 * width_after + width_before, b = width_after + 2.0 * width_before;
            keys_[i].slopes[n] = (a + b) / (a / before + b / after);
        }
    }
}

std::string KeyedText::at(long frame) const {
    const auto next = std::find_if(keys_.begin(), keys_.end(), [&](const Key& key) { return key.frame > frame; });
    std::vector<double> numbers = next == keys_.begin() ? keys_.front().numbers : (next - 1)->numbers;
    if (next != keys_.begin() && next != keys_.end()) {
        const Key& from = *(next - 1);
        const auto width = double(next->frame - from.frame);
        const double t = double(frame - from.frame) / width;
        for (std::size_t n = 0; n < numbers.size(); ++n) {
            const double rise = next->numbers[n] - from.numbers[n];
            const double a = from.slopes[n] * width - rise, b = rise - next->slopes[n] * width;
            numbers[n] += t * rise + t * (1.0 - t) * (a * (1.0 - t) + b * t);
        }
    }
    return fmt::format("{}:{:.17g}", kind_, fmt::join(numbers, ","));
}

}  // namespace pellucid::sequence
