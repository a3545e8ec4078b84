#include "scene/mesh_file_checks.h"

#include "core/fail.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <string_view>

namespace pellucid {
namespace {

/// Lines of an OFF file that are neither empty nor comments.
class OffLines {
public:
    OffLines(const std::filesystem::path& file, std::string_view text) : file_(file), text_(text) {}

    /// How far has been read.
    std::size_t at() const { return std::min(at_, text_.size()); }

    std::string_view next() {
        while (at_ < text_.size()) {
            const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
            std::string_view line = text_.substr(at_, end - at_);
            at_ = end + 1;
            line = line.substr(0, line.find('#'));
            const std::size_t begin = line.find_first_not_of(" \t");
            if (begin != line.npos) return line.substr(begin);
        }
        fail(file_, "OFF: the file ends early (truncated?)");
    }

private:
    const std::filesystem::path& file_;
    std::string_view text_;
    std::size_t at_ = 0;
};

/// Takes the next number off the front of a line.
bool take_number(std::string_view& line, std::uint64_t& number) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    const auto [last, error] = std::from_chars(line.data(), line.data() + line.size(), number);
    line.remove_prefix(std::size_t(last - line.data()));
    return error == std::errc() && (line.empty() || line[0] == ' ' || line[0] == '\t');
}

std::uint64_t check_off(const std::filesystem::path& file, std::vector<std::byte>& bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    OffLines lines(file, text);
    std::string_view head = lines.next();
    const std::size_t magic = head.find("OFF");
    // Before OFF stand flags for what a vertex has besides its position: ST, C, N, 4, n.
    if (magic == head.npos || head.find_first_not_of("STCN4n") < magic)
        fail(file, "is no OFF file: it does not begin with \"OFF\"");
    head.remove_prefix(magic + 3);
    if (head.find("BINARY") != head.npos) fail(file, "binary OFF files are not supported");
    if (head.find_first_not_of(" \t") == head.npos) head = lines.next();

    std::uint64_t vertices = 0, faces = 0, edges = 0;
    if (!take_number(head, vertices) || !take_number(head, faces) || !take_number(head, edges))
        fail(file, "OFF: the line with the numbers of vertices, faces and edges is malformed");
    if (vertices > text.size() || faces > text.size())
        fail(file, fmt::format("OFF: {} vertices and {} faces in a file of {} bytes", vertices, faces, text.size()));
    for (std::uint64_t v = 0; v < vertices; ++v) lines.next();
    for (std::uint64_t f = 0; f < faces; ++f) {
        std::string_view line = lines.next();
        std::uint64_t corners = 0, index = 0;
        if (!take_number(line, corners)) fail(file, fmt::format("OFF: face {} is malformed", f));
        for (std::uint64_t k = 0; k < corners; ++k) {
            if (!take_number(line, index))
                fail(file, fmt::format("OFF: face {} does not have its {} vertices", f, corners));
            if (index >= vertices)
                fail(file, fmt::format("OFF: face {} refers to vertex {}, there are {}", f, index, vertices));
        }
    }
    // For every face that it skips (none or more than nine corners) assimp takes one off the count and
    // reads on, at last below none.
    bytes.resize(lines.at());
    return faces;
}

void check_stl(const std::filesystem::path& file, std::string_view text) {
    constexpr std::size_t kHeader = 84, kTriangle = 50;
    std::uint32_t count = 0;
    if (text.size() >= kHeader) std::memcpy(&count, text.data() + 80, 4);
    // Exactly this length is what makes a binary file: many of them begin with "solid", too.
    if (text.size() >= kHeader && text.size() == kHeader + std::uint64_t(count) * kTriangle) return;
    if (text.starts_with("solid")) {
        std::size_t facets = 0, ends = 0;
        for (std::size_t at = text.find("facet"); at != text.npos; at = text.find("facet", at + 5))
            at >= 3 && text.substr(at - 3, 3) == "end" ? ++ends : ++facets;
        if (facets == 0) fail(file, "STL: no facets");
        if (facets != ends) fail(file, "STL: the last facet is incomplete (truncated?)");
        return;
    }
    if (text.size() < kHeader) fail(file, "is no STL file: it is too short");
    fail(file, fmt::format("STL: header announces {} triangles, the file has {} bytes instead of {}", count,
                           text.size(), kHeader + std::uint64_t(count) * kTriangle));
}

void check_3ds(const std::filesystem::path& file, std::string_view text) {
    std::uint16_t id = 0;
    std::uint32_t length = 0;
    if (text.size() >= 6) {
        std::memcpy(&id, text.data(), 2);
        std::memcpy(&length, text.data() + 2, 4);
    }
    if (id != 0x4d4d) fail(file, "is no 3DS file: its first chunk is not 0x4D4D");
    if (length > text.size()) fail(file, fmt::format("3DS: the file ends early: {} of {} bytes", text.size(), length));
}

}  // namespace

std::optional<std::uint64_t> check_mesh_file(const std::filesystem::path& file, const std::string& extension,
                                             std::vector<std::byte>& bytes) {
    if (bytes.empty()) fail(file, "is empty");
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (extension == ".ply") return check_ply(file, bytes);
    if (extension == ".off") return check_off(file, bytes);
    if (extension == ".stl") check_stl(file, text);
    if (extension == ".3ds") check_3ds(file, text);
    if (extension == ".obj") check_obj(file, bytes);
    return std::nullopt;
}

}  // namespace pellucid
