// OFF (Geomview manual, section 4.2.5 "OFF Files"): text, with or without normals, colours and texture coordinates.
#include "core/fail.h"
#include "scene/mesh_files/read_mesh_files.h"
#include "scene/mesh_files/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace pellucid {
namespace {

/// What a vertex has, by the letters before "OFF".
struct OffKind {
    bool texcoords = false, colors = false, normals = false, weight = false;
    std::size_t position_and_normal() const { return 3 + std::size_t(weight) + (normals ? 3u : 0u); }  ///< numbers
    std::size_t all() const { return position_and_normal() + (colors ? 4u : 0u) + (texcoords ? 2u : 0u); }
};

bool parse_kind(std::string_view keyword, OffKind& kind) {
    if (!keyword.ends_with("OFF")) return false;
    keyword.remove_suffix(3);
    while (!keyword.empty()) {  // in the order ST, C, N, 4, but not all programs keep to it
        const std::size_t letters = keyword.starts_with("ST") ? 2 : 1;
        if (letters == 2)
            kind.texcoords = true;
        else if (keyword[0] == 'C')
            kind.colors = true;
        else if (keyword[0] == 'N')
            kind.normals = true;
        else if (keyword[0] == '4')
            kind.weight = true;
        else
            return false;
        keyword.remove_prefix(letters);
    }
    return true;
}

/// Spaces in place of comments.
std::string without_comments(std::string_view text) {
    std::string plain(text);
    for (std::size_t at = plain.find('#'); at != plain.npos; at = plain.find('#', at))
        for (; at < plain.size() && plain[at] != '\n' && plain[at] != '\r'; ++at) plain[at] = ' ';
    return plain;
}

class OffReader {
public:
    OffReader(const std::filesystem::path& file, std::string_view text) : file_(file), text_(text), words_(text) {}

    PolygonFile read(Warnings& warnings) {
        read_header();
        // Programs disagree on how many numbers a colour has, but they write one vertex or face to a line.
        if (!one_to_a_line(words_.at())) {
            for (std::uint64_t v = 0; v < vertices_; ++v) read_vertex(v, words_, kind_.all());
            for (std::uint64_t f = 0; f < faces_; ++f) read_face(f, words_);
            if (!words_.next().empty()) fail(file_, "OFF: there is more data than the header announces");
        } else {
            Lines lines(text_, words_.at());
            std::string_view line;
            for (std::uint64_t i = 0; i < vertices_ + faces_ && lines.next(line);) {
                Words words(line);
                if (words.rest().empty()) continue;
                i < vertices_ ? read_vertex(i, words, kind_.position_and_normal()) : read_face(i - vertices_, words);
                ++i;
            }
            if (!Words(text_, lines.at()).next().empty())
                warnings.add(fmt::format("{}: has more lines than it announces, left out", file_.filename().string()));
        }
        if (kind_.normals && kind_.colors) {
            // Some programs write the colour before the normal.
            content_.normals.clear();
            for (PolygonCorner& corner : content_.corners) corner.normal = kNoIndex;
            warnings.add(fmt::format("{}: normals beside colours are not read: made anew", file_.filename().string()));
        }
        if (kind_.colors)
            warnings.add(
                fmt::format("{}: colours of vertices are not used: the file is glass", file_.filename().string()));
        return std::move(content_);
    }

private:
    void read_header() {
        const std::string_view keyword = words_.next();
        if (keyword.ends_with("nOFF")) fail(file_, "OFF files of N dimensions are not supported; write one of 3");
        if (!parse_kind(keyword, kind_)) fail(file_, "is no OFF file: it does not begin with \"OFF\"");
        std::string_view word = words_.next();
        if (word == "BINARY") fail(file_, "binary OFF files are not supported; write it as text");
        std::array<std::uint64_t, 2> counts{};
        for (std::size_t k = 0; k < counts.size(); ++k) {
            const std::optional<std::int64_t> count = parse_integer(word);
            if (!count || *count < 0)
                fail(file_,
                     fmt::format("OFF: \"{}\" where the numbers of vertices and faces are expected", shortened(word)));
            counts[k] = std::uint64_t(*count);
            if (k == 0) word = words_.next();
        }
        vertices_ = counts[0], faces_ = counts[1];
        // The number of edges is not used; some programs leave it out.
        const std::size_t line_end = std::min(text_.find_first_of("\r\n", words_.at()), text_.size());
        const bool edges_on_line = !Words(text_.substr(0, line_end), words_.at()).next().empty();
        if (edges_on_line || !one_to_a_line(words_.at())) words_.next();
        if (vertices_ > text_.size() || faces_ > text_.size())
            fail(file_,
                 fmt::format("OFF: {} vertices and {} faces in a file of {} bytes", vertices_, faces_, text_.size()));
    }

    /// Whether each vertex and each face has a line of its own.
    bool one_to_a_line(std::size_t begin) const {
        Lines lines(text_, begin);
        std::uint64_t seen = 0;
        for (std::string_view line; seen < vertices_ + faces_ && lines.next(line);) {
            Words words(line);
            const std::string_view first = words.next();
            if (first.empty()) continue;
            std::int64_t wanted = std::int64_t(kind_.position_and_normal()) - 1;  // after the first
            if (seen++ >= vertices_) wanted = parse_integer(first).value_or(-1);
            if (wanted < 0) return false;
            for (std::int64_t k = 0; k < wanted; ++k)
                if (words.next().empty()) return false;
        }
        return seen == vertices_ + faces_;
    }

    double number(const char* element, std::uint64_t index, Words& words) const {
        const std::string_view word = words.next();
        if (word.empty()) fail(file_, fmt::format("OFF: {} {}: the file ends early (truncated?)", element, index));
        const std::optional<double> value = parse_real(word);
        if (!value) fail(file_, fmt::format("OFF: {} {}: \"{}\" is no number", element, index, shortened(word)));
        return *value;
    }

    /// Takes the first `count` numbers of a vertex.
    void read_vertex(std::uint64_t index, Words& words, std::size_t count) {
        std::array<double, 13> v{};
        for (std::size_t k = 0; k < count; ++k) v[k] = number("vertex", index, words);
        glm::dvec3 position(v[0], v[1], v[2]);
        if (kind_.weight) position /= v[3];
        content_.positions.push_back(position);
        if (!kind_.normals) return;
        const double* n = &v[kind_.weight ? 4 : 3];
        const glm::vec3 normal(n[0], n[1], n[2]);
        content_.normals.push_back(std::isfinite(normal.x + normal.y + normal.z) ? normal : glm::vec3(0.0f));
    }

    void read_face(std::uint64_t index, Words& words) {
        const auto integer = [&] {
            const double value = number("face", index, words);
            if (!(std::abs(value) < 9e15) || value != std::floor(value))
                fail(file_, fmt::format("OFF: face {}: {} where a whole number is expected", index, value));
            return std::int64_t(value);
        };
        const std::int64_t corners = integer();
        if (corners < 0) fail(file_, fmt::format("OFF: face {} has {} corners", index, corners));
        for (std::int64_t k = 0; k < corners; ++k) {
            const std::int64_t vertex = integer();
            if (vertex < 0 || std::uint64_t(vertex) >= vertices_)
                fail(file_, fmt::format("OFF: face {} refers to vertex {}, there are {}", index, vertex, vertices_));
            content_.corners.push_back(
                {.position = std::uint32_t(vertex), .normal = kind_.normals ? std::uint32_t(vertex) : kNoIndex});
        }
        if (content_.corners.size() >= kNoIndex) fail(file_, "OFF: more than 2^32 corners");
        if (corners > 0) content_.end_polygon();
    }

    const std::filesystem::path& file_;
    std::string_view text_;
    Words words_;
    OffKind kind_;
    std::uint64_t vertices_ = 0, faces_ = 0;
    PolygonFile content_;
};

}  // namespace

PolygonFile read_off(const std::filesystem::path& file, std::vector<std::byte> bytes, Warnings& warnings) {
    make_utf8(bytes);
    const std::string plain = without_comments(as_text(bytes));
    return OffReader(file, plain).read(warnings);
}

}  // namespace pellucid
