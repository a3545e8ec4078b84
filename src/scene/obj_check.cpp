// Checks the faces of a Wavefront OBJ file ("Object Files", Advanced Visualizer Manual, appendix B1)
// and rewrites what assimp does not read.
#include "core/fail.h"
#include "scene/mesh_file_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

namespace pellucid {
namespace {

/// assimp takes ".5" for no number at all (it needs "0.5"), and reads past the end of a file whose
/// last line is continued or has no end.
std::vector<std::byte> plain_obj(std::string_view text) {
    std::vector<std::byte> plain;
    plain.reserve(text.size() + text.size() / 8 + 1);
    const auto at = [&](std::size_t i) { return i < text.size() ? text[i] : '\n'; };
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\\') {
            // Joins two lines; elsewhere it only stands in names, which are not read.
            plain.push_back(std::byte(' '));
            if (at(i + 1) == '\r' && at(i + 2) == '\n') ++i;
            if (at(i + 1) == '\n' || at(i + 1) == '\r') ++i;
            continue;
        }
        const bool bare = text[i] == '.' && i > 0 && text[i - 1] == ' ' && at(i + 1) >= '0' && at(i + 1) <= '9';
        if (bare) plain.push_back(std::byte('0'));
        plain.push_back(std::byte(text[i]));
    }
    plain.push_back(std::byte('\n'));
    return plain;
}

/// Vertices (or normals) of a file and the greatest number by which faces refer to them.
struct References {
    const char* what;
    std::int64_t count = 0;
    std::int64_t greatest = 0;
    std::size_t line = 0;  ///< where `greatest` stands

    /// Negative numbers count backwards from the last one read so far.
    bool add(std::int64_t number, std::size_t at_line) {
        if (number < 0) return -number <= count;
        if (number > greatest) {
            greatest = number;
            line = at_line;
        }
        return number != 0;
    }
};

/// Reads the corners "v", "v/t", "v//n" or "v/t/n" of a face. What is no number ends the line: it
/// is left to assimp to complain.
void check_face(const std::filesystem::path& file, std::string_view line, std::size_t line_number, References& vertices,
                References& normals) {
    const char* at = line.data();
    const char* const end = at + line.size();
    const auto number = [&](std::int64_t& value) {
        const auto [last, error] = std::from_chars(at, end, value);
        if (error == std::errc::result_out_of_range) value = 0;  // as wrong as 0, which none has
        at = last;
        return error != std::errc::invalid_argument;
    };
    const auto check = [&](References& references, std::int64_t value) {
        if (!references.add(value, line_number))
            fail(file, fmt::format("line {}: face refers to a {} that does not exist", line_number, references.what));
    };
    for (std::int64_t value = 0;;) {
        at = std::find_if(at, end, [](char c) { return c != ' ' && c != '\t'; });
        if (!number(value)) return;
        check(vertices, value);
        if (at == end || *at != '/') continue;
        ++at;
        number(value);  // texture coordinates are not used
        if (at == end || *at != '/') continue;
        ++at;
        if (number(value)) check(normals, value);
    }
}

}  // namespace

void check_obj(const std::filesystem::path& file, std::vector<std::byte>& bytes) {
    bytes = plain_obj({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    References vertices{.what = "vertex"}, normals{.what = "normal"};
    std::size_t line_number = 1;
    for (std::size_t begin = 0; begin < text.size(); ++line_number) {
        const std::size_t end = text.find('\n', begin);
        std::string_view line = text.substr(begin, end - begin);
        begin = end + 1;
        line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
        if (line.starts_with("v ") || line.starts_with("v\t")) ++vertices.count;
        if (line.starts_with("vn ") || line.starts_with("vn\t")) ++normals.count;
        if (line.starts_with("f ") || line.starts_with("f\t"))
            check_face(file, line.substr(2), line_number, vertices, normals);
    }
    // Some programs write references to normals without the normals; those are made then.
    if (normals.count == 0) normals.greatest = 0;
    for (const References& r : {vertices, normals})
        if (r.greatest > r.count)
            fail(file, fmt::format("line {}: face refers to {} {}, there are {}", r.line, r.what, r.greatest, r.count));
}

}  // namespace pellucid
