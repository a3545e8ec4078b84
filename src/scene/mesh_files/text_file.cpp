#include "scene/mesh_files/text_file.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <system_error>

namespace pellucid {
namespace {

void append_utf8(std::vector<std::byte>& bytes, std::uint32_t code) {
    const auto put = [&](std::uint32_t value) { bytes.push_back(std::byte(value)); };
    if (code < 0x80) return put(code);
    if (code < 0x800) {
        put(0xc0 | code >> 6);
    } else {
        if (code < 0x10000) {
            put(0xe0 | code >> 12);
        } else {
            put(0xf0 | code >> 18);
            put(0x80 | (code >> 12 & 0x3f));
        }
        put(0x80 | (code >> 6 & 0x3f));
    }
    put(0x80 | (code & 0x3f));
}

std::vector<std::byte> utf8_of_utf16(const std::vector<std::byte>& bytes, std::size_t begin, bool big_endian) {
    std::vector<std::byte> result;
    result.reserve(bytes.size() / 2);
    const auto unit = [&](std::size_t i) {
        const auto low = std::uint32_t(bytes[i + (big_endian ? 1 : 0)]);
        return std::uint32_t(bytes[i + (big_endian ? 0 : 1)]) << 8 | low;
    };
    for (std::size_t i = begin; i + 1 < bytes.size(); i += 2) {
        std::uint32_t code = unit(i);
        const bool high = code >= 0xd800 && code < 0xdc00;
        if (high && i + 3 < bytes.size() && unit(i + 2) >= 0xdc00 && unit(i + 2) < 0xe000) {
            code = 0x10000 + ((code - 0xd800) << 10) + (unit(i + 2) - 0xdc00);
            i += 2;
        }
        append_utf8(result, code);
    }
    return result;
}

}  // namespace

void make_utf8(std::vector<std::byte>& bytes) {
    const auto starts_with = [&](std::initializer_list<int> mark) {
        return bytes.size() >= mark.size() &&
               std::equal(mark.begin(), mark.end(), bytes.begin(), [](int a, std::byte b) { return a == int(b); });
    };
    const auto is_character = [&](std::size_t i) { return bytes[i] != std::byte(0) && int(bytes[i]) < 0x80; };
    const bool pair = bytes.size() >= 2;
    if (starts_with({0xef, 0xbb, 0xbf})) {
        bytes.erase(bytes.begin(), bytes.begin() + 3);
    } else if (starts_with({0xff, 0xfe}) || starts_with({0xfe, 0xff})) {
        bytes = utf8_of_utf16(bytes, 2, bytes[0] == std::byte(0xfe));
    } else if (pair &&
               ((is_character(0) && bytes[1] == std::byte(0)) || (bytes[0] == std::byte(0) && is_character(1)))) {
        bytes = utf8_of_utf16(bytes, 0, bytes[0] == std::byte(0));
    }
}

std::optional<double> parse_real(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0.0;
    const auto [last, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::invalid_argument) return std::nullopt;
    // Old C libraries of Windows write 1.#INF, -1.#IND and 1.#QNAN.
    const auto length = std::size_t(last - word.data());
    if (word.substr(length).starts_with('#') && (word.starts_with("1.") || word.starts_with("-1.")))
        return std::numeric_limits<double>::quiet_NaN();
    if (length != word.size()) return std::nullopt;
    if (error == std::errc::result_out_of_range) value = std::strtod(std::string(word).c_str(), nullptr);
    return value;
}

std::optional<std::int64_t> parse_integer(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    std::int64_t value = 0;
    const auto [last, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::invalid_argument || last != word.data() + word.size()) return std::nullopt;
    if (error == std::errc::result_out_of_range)
        value =
            word.starts_with('-') ? std::numeric_limits<std::int64_t>::min() : std::numeric_limits<std::int64_t>::max();
    return value;
}

std::string lower_case(std::string_view text) {
    std::string lower(text);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return lower;
}

std::string_view Words::next() {
    const std::size_t begin = std::min(text_.find_first_not_of(kBlank, at_), text_.size());
    at_ = std::min(text_.find_first_of(kBlank, begin), text_.size());
    return text_.substr(begin, at_ - begin);
}

std::string_view Words::rest() const {
    const std::size_t begin = text_.find_first_not_of(kBlank, at_);
    if (begin == text_.npos) return {};
    return text_.substr(begin, text_.find_last_not_of(kBlank) + 1 - begin);
}

bool Lines::next(std::string_view& line) {
    if (at_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
    line = text_.substr(at_, end - at_);
    at_ = end + 1;
    if (end + 1 < text_.size() && text_[end] == '\r' && text_[end + 1] == '\n') ++at_;
    ++number_;
    return true;
}

bool Lines::next_joined(std::string_view& line, std::string& buffer) {
    if (!next(line)) return false;
    const std::size_t first = line.find_first_not_of(kBlank);
    if (!line.ends_with('\\') || line[first] == '#') return true;
    buffer.clear();
    while (line.ends_with('\\')) {
        buffer.append(line.substr(0, line.size() - 1)) += ' ';
        if (!next(line)) line = {};
    }
    buffer += line;
    line = buffer;
    return true;
}

std::size_t line_of(std::string_view text, std::size_t offset) {
    Lines lines(text);
    for (std::string_view line; lines.next(line);)
        if (lines.at() > offset) break;
    return lines.number();
}

}  // namespace pellucid
