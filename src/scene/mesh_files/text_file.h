#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// Whitespace within and between lines of text.
inline constexpr std::string_view kBlank = " \t\r\n\v\f";

/// Removes a UTF-8 byte order mark, and decodes UTF-16 of either byte order, with a mark or recognised by the zeros
/// of its first character.
void make_utf8(std::vector<std::byte>& bytes);

/// The bytes of a file as characters.
inline std::string_view as_text(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A decimal number, "nan" and "inf" in their spellings included. A number too small for a double is 0, one too large
/// infinite.
std::optional<double> parse_real(std::string_view word);
/// A whole number. Out of the range of 64 bits: the nearest in it.
std::optional<std::int64_t> parse_integer(std::string_view word);

/// ASCII only.
std::string lower_case(std::string_view text);

/// Walks through the words of a text.
class Words {
public:
    explicit Words(std::string_view text, std::size_t at = 0) : text_(text), at_(at) {}

    /// Empty at the end.
    std::string_view next();
    /// The rest of the text, without blanks at its ends.
    std::string_view rest() const;
    std::size_t at() const { return at_; }  ///< offset of the end of the last word

private:
    std::string_view text_;
    std::size_t at_ = 0;
};

/// Walks through the lines of a text, which end in \n, \r\n or \r.
class Lines {
public:
    explicit Lines(std::string_view text, std::size_t at = 0) : text_(text), at_(at) {}

    /// The next line without its end; false after the last.
    bool next(std::string_view& line);
    /// As next(), and joins lines that end in a backslash, but for comments that begin with '#'. `buffer` keeps joined
    /// lines.
    bool next_joined(std::string_view& line, std::string& buffer);
    std::size_t number() const { return number_; }  ///< of the last line, from 1
    std::size_t at() const { return at_; }          ///< offset of the next line

private:
    std::string_view text_;
    std::size_t at_ = 0, number_ = 0;
};

/// Line number, from 1, of an offset in a text.
std::size_t line_of(std::string_view text, std::size_t offset);

}  // namespace pellucid
