#include "scene/text_positions.h"

#include "scene/far_positions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <optional>
#include <string_view>

namespace pellucid {
namespace {

constexpr std::string_view kBlank = " \t\r\n\v\f";
constexpr std::string_view kLineEnd = "\r\n";

/// A position in a text.
struct TextPosition {
    std::size_t begin = 0, end = 0;  ///< of its three numbers
    std::size_t extra_end = 0;       ///< end of what is removed after them
    glm::dvec3 value{0.0};
};

std::optional<double> number(std::string_view token) {
    if (token.starts_with('+')) token.remove_prefix(1);
    double value = 0.0;
    const auto [last, error] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (error != std::errc() || last != token.data() + token.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

/// 0 where it is none.
std::uint64_t count_of(std::string_view token) {
    std::uint64_t count = 0;
    const auto [last, error] = std::from_chars(token.data(), token.data() + token.size(), count);
    return error == std::errc() && last == token.data() + token.size() ? count : 0;
}

/// Walks through the words of a text.
class Words {
public:
    Words(std::string_view text, std::size_t begin, std::size_t end) : text_(text.substr(0, end)), at_(begin) {}

    /// Empty at the end.
    std::string_view next() {
        begin_ = std::min(text_.find_first_not_of(kBlank, at_), text_.size());
        at_ = std::min(text_.find_first_of(kBlank, begin_), text_.size());
        return text_.substr(begin_, at_ - begin_);
    }
    std::size_t begin() const { return begin_; }  ///< of the word that next() returned
    std::size_t end() const { return at_; }

private:
    std::string_view text_;
    std::size_t begin_ = 0, at_ = 0;
};

/// The next three words as a position.
std::optional<TextPosition> take_position(Words& words) {
    TextPosition position;
    for (int k = 0; k < 3; ++k) {
        const std::optional<double> coordinate = number(words.next());
        if (!coordinate) return std::nullopt;
        if (k == 0) position.begin = words.begin();
        position.value[k] = *coordinate;
    }
    position.end = position.extra_end = words.end();
    return position;
}

/// Calls `visit(begin, end)` for every line that is not blank, until it returns false. Returns whether it never did.
template <class Visit>
bool for_each_line(std::string_view text, std::size_t begin, Visit&& visit) {
    while ((begin = text.find_first_not_of(kBlank, begin)) != text.npos) {
        const std::size_t end = std::min(text.find_first_of(kLineEnd, begin), text.size());
        if (!visit(begin, end)) return false;
        begin = end;
    }
    return true;
}

// Each of these calls `visit` with every position in the text, in order. They return false where the text is not what
// they expect.

template <class Visit>
bool visit_obj(std::string_view text, Visit&& visit) {
    return for_each_line(text, 0, [&](std::size_t begin, std::size_t end) {
        Words words(text, begin, end);
        if (words.next() != "v") return true;
        std::optional<TextPosition> position = take_position(words);
        if (!position) return false;
        // Six numbers are a position and a colour, four a position and its weight.
        const std::string_view fourth = words.next();
        const std::size_t fourth_end = words.end();
        if (number(fourth) && words.next().empty()) position->extra_end = fourth_end;
        visit(*position);
        return true;
    });
}

template <class Visit>
bool visit_off(std::string_view text, Visit&& visit) {
    const auto without_comment = [&](std::size_t begin, std::size_t end) {
        const std::size_t length = text.substr(begin, end - begin).find('#');
        return text.substr(0, length == text.npos ? end : begin + length);
    };
    std::uint64_t left = 0;
    bool known = false, head = true, right = true;
    for_each_line(text, 0, [&](std::size_t begin, std::size_t end) {
        const std::string_view line = without_comment(begin, end);
        Words words(line, begin, line.size());
        std::string_view word = words.next();
        if (word.empty()) return true;
        if (head && !known) {
            known = true;
            // With four or N coordinates a vertex is something else.
            right = word.ends_with("OFF") && word.find_first_of("4n") == word.npos;
            word = words.next();
            if (!right || word.empty()) return right;
        }
        if (head) {
            head = false;
            left = count_of(word);
            return left > 0;
        }
        Words coordinates(line, begin, line.size());
        const std::optional<TextPosition> position = take_position(coordinates);
        right = position.has_value();
        if (right) visit(*position);
        return right && --left > 0;
    });
    return right && left == 0;
}

template <class Visit>
bool visit_stl(std::string_view text, Visit&& visit) {
    const auto same = [](char a, char b) { return (a >= 'A' && a <= 'Z' ? char(a - 'A' + 'a') : a) == b; };
    constexpr std::string_view kVertex = "vertex";
    Words words(text, 0, text.size());
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
        if (!std::equal(word.begin(), word.end(), kVertex.begin(), kVertex.end(), same)) continue;
        const std::optional<TextPosition> position = take_position(words);
        if (!position) return false;
        visit(*position);
    }
    return true;
}

/// Where the positions of a PLY file are. Its header is plain: check_mesh_file() wrote it.
struct PlyLayout {
    std::size_t body = 0;  ///< offset in the file
    std::string_view format;
    std::uint64_t vertices = 0;
    std::vector<std::string_view> types;      ///< of a vertex's properties
    std::array<int, 3> at{-1, -1, -1};        ///< which properties x, y and z are
    std::array<std::string_view, 3> of_type;  ///< theirs
};

/// Nothing if vertices are not the first element, or have lists or coordinates of whole numbers.
std::optional<PlyLayout> ply_layout(std::string_view text) {
    PlyLayout layout;
    int elements = 0;
    bool right = true;
    for_each_line(text, 0, [&](std::size_t begin, std::size_t end) {
        Words words(text, begin, end);
        const std::string_view word = words.next(), second = words.next(), third = words.next();
        if (word == "format") layout.format = second;
        if (word == "element" && ++elements == 1) {
            right = second == "vertex";
            layout.vertices = count_of(third);
        }
        if (word == "property" && elements == 1) {
            right = right && second != "list";
            for (std::size_t k = 0; k < 3; ++k) {
                if (third.size() != 1 || third[0] != "xyz"[k]) continue;
                layout.at[k] = int(layout.types.size());
                layout.of_type[k] = second;
            }
            layout.types.push_back(second);
        }
        layout.body = end + 1;
        return word != "end_header";
    });
    for (std::size_t k = 0; k < 3; ++k)
        right = right && layout.at[k] == layout.at[0] + int(k) && layout.at[0] >= 0 &&
                (layout.of_type[k].starts_with("float") || layout.of_type[k].starts_with("double"));
    return right && layout.body <= text.size() ? std::optional(layout) : std::nullopt;
}

template <class Visit>
bool visit_ascii_ply(std::string_view text, const PlyLayout& layout, Visit&& visit) {
    Words words(text, layout.body, text.size());
    for (std::uint64_t v = 0; v < layout.vertices; ++v) {
        std::size_t i = 0;
        for (; i < std::size_t(layout.at[0]); ++i) words.next();
        const std::optional<TextPosition> position = take_position(words);
        if (!position) return false;
        visit(*position);
        for (i += 3; i < layout.types.size(); ++i) words.next();
    }
    return true;
}

/// A PLY file that stores positions as 64-bit numbers.
glm::dvec3 rebase_binary_ply(std::vector<std::byte>& bytes, const PlyLayout& layout) {
    const auto size_of = [](std::string_view type) -> std::size_t {
        if (type.ends_with("64") || type == "double") return 8;
        if (type.ends_with("32") || type == "float" || type == "int" || type == "uint") return 4;
        return type.ends_with("16") || type.ends_with("short") ? 2 : 1;
    };
    std::size_t stride = 0, offset = 0;
    for (std::size_t i = 0; i < layout.types.size(); ++i) {
        if (int(i) == layout.at[0]) offset = stride;
        stride += size_of(layout.types[i]);
    }
    const bool doubles = std::all_of(layout.of_type.begin(), layout.of_type.end(),
                                     [&](std::string_view type) { return size_of(type) == 8; });
    if (!doubles || layout.vertices * stride > bytes.size() - layout.body) return glm::dvec3(0.0);
    const bool swapped = layout.format == "binary_big_endian";
    const auto for_each_position = [&](auto&& change) {
        for (std::uint64_t v = 0; v < layout.vertices; ++v) {
            std::byte* const at = bytes.data() + layout.body + v * stride + offset;
            glm::dvec3 position;
            const auto swap = [&] {
                for (std::size_t k = 0; swapped && k < 3; ++k) std::reverse(at + 8 * k, at + 8 * (k + 1));
            };
            swap();
            std::memcpy(&position.x, at, sizeof position);
            change(position);
            std::memcpy(at, &position.x, sizeof position);
            swap();
        }
    };
    Box box;
    for_each_position([&](const glm::dvec3& position) { box.add(position); });
    const glm::dvec3 origin = frame_origin(box);
    if (origin != glm::dvec3(0.0)) for_each_position([&](glm::dvec3& position) { position -= origin; });
    return origin;
}

/// `visit_all(visit)` calls `visit` with each position of `bytes`.
template <class VisitAll>
glm::dvec3 rebase_text(std::vector<std::byte>& bytes, VisitAll&& visit_all) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    Box box;
    bool extras = false;
    const bool understood = visit_all([&](const TextPosition& position) {
        box.add(position.value);
        extras = extras || position.extra_end != position.end;
    });
    const glm::dvec3 origin = understood ? frame_origin(box) : glm::dvec3(0.0);
    const bool moved = origin != glm::dvec3(0.0);
    if (!understood || (!moved && !extras)) return origin;
    std::string rewritten;
    rewritten.reserve(text.size() + text.size() / 4);
    std::size_t copied = 0;
    visit_all([&](const TextPosition& position) {
        rewritten.append(text, copied, position.begin - copied);
        const glm::dvec3 p = position.value - origin;
        if (moved)
            fmt::format_to(std::back_inserter(rewritten), "{:.9g} {:.9g} {:.9g}", p.x, p.y, p.z);
        else
            rewritten.append(text, position.begin, position.end - position.begin);
        copied = position.extra_end;
    });
    rewritten.append(text, copied);
    const auto* const begin = reinterpret_cast<const std::byte*>(rewritten.data());
    bytes.assign(begin, begin + rewritten.size());
    return origin;
}

}  // namespace

glm::dvec3 rebase_stored_positions(const std::string& extension, std::vector<std::byte>& bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (extension == ".obj") return rebase_text(bytes, [&](auto&& visit) { return visit_obj(text, visit); });
    if (extension == ".off") return rebase_text(bytes, [&](auto&& visit) { return visit_off(text, visit); });
    if (extension == ".stl") {
        constexpr std::size_t kHeader = 84, kTriangle = 50;
        std::uint32_t count = 0;
        if (text.size() >= kHeader) std::memcpy(&count, text.data() + 80, 4);
        if (text.size() == kHeader + std::uint64_t(count) * kTriangle) return glm::dvec3(0.0);
        return rebase_text(bytes, [&](auto&& visit) { return visit_stl(text, visit); });
    }
    if (extension != ".ply") return glm::dvec3(0.0);
    const std::optional<PlyLayout> layout = ply_layout(text);
    if (!layout) return glm::dvec3(0.0);
    if (layout->format != "ascii") return rebase_binary_ply(bytes, *layout);
    return rebase_text(bytes, [&](auto&& visit) { return visit_ascii_ply(text, *layout, visit); });
}

}  // namespace pellucid
