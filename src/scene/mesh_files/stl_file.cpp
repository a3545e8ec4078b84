// STL (3D Systems, "Stereolithography Interface Specification", 1989): text or binary. Stored normals are not read: they
// are those of the facets, or zero.
#include "core/fail.h"
#include "scene/mesh_files/read_mesh_files.h"
#include "scene/mesh_files/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

namespace pellucid {
namespace {

constexpr std::size_t kHeader = 84, kFacet = 50;  // bytes

/// Binary files may begin with "solid", too; and text files may have any length.
bool is_text(std::string_view bytes) {
    const std::size_t first = std::min(bytes.find_first_not_of(kBlank), bytes.size());
    if (lower_case(bytes.substr(first, 5)) != "solid") return false;
    const std::string_view head = bytes.substr(0, 1024);
    if (head.find('\0') != head.npos) return false;
    std::uint32_t count = 0;
    if (bytes.size() >= kHeader) std::memcpy(&count, bytes.data() + 80, 4);
    if (bytes.size() == kHeader + std::uint64_t(count) * kFacet) return false;
    const std::string lower = lower_case(head);
    return lower.find("facet") != lower.npos || lower.find("endsolid") != lower.npos || bytes.size() < kHeader;
}

class StlText {
public:
    StlText(const std::filesystem::path& file, std::string_view text) : file_(file), text_(text), words_(text) {}

    PolygonFile read() {
        bool in_facet = false;
        std::size_t facets = 0;
        for (std::string word = next(); !word.empty(); word = next()) {
            if (word == "solid" || word == "endsolid") {
                if (in_facet) fail_here("the facet has no endfacet");
                skip_line();  // a name of any words
            } else if (word == "facet") {
                if (in_facet) fail_here("the facet before has no endfacet");
                in_facet = true;
                ++facets;
            } else if (word == "vertex") {
                if (!in_facet) fail_here("a vertex outside of a facet");
                read_vertex();
            } else if (word == "endfacet") {
                if (!in_facet) fail_here("endfacet without a facet");
                in_facet = false;
                content_.end_polygon();
            }
        }
        if (facets == 0) fail(file_, "STL: no facets");
        if (in_facet) fail(file_, "STL: the last facet is incomplete (truncated?)");
        return std::move(content_);
    }

private:
    [[noreturn]] void fail_here(const std::string& cause) const {
        fail(file_, fmt::format("STL: line {}: {}", line_of(text_, words_.at() - 1), cause));
    }

    std::string next() { return lower_case(words_.next()); }

    void skip_line() {
        const std::size_t end = std::min(text_.find_first_of("\r\n", words_.at()), text_.size());
        words_ = Words(text_, end);
    }

    void read_vertex() {
        glm::dvec3 position;
        for (int k = 0; k < 3; ++k) {
            const std::string_view word = words_.next();
            const std::optional<double> value = parse_real(word);
            if (!value) fail_here(fmt::format("\"{}\" is no coordinate of a vertex", shortened(word)));
            position[k] = *value;
        }
        content_.corners.push_back({.position = std::uint32_t(content_.positions.size())});
        content_.positions.push_back(position);
    }

    const std::filesystem::path& file_;
    std::string_view text_;
    Words words_;
    PolygonFile content_;
};

PolygonFile read_binary(const std::filesystem::path& file, std::string_view bytes, Warnings& warnings) {
    if (bytes.size() < kHeader) fail(file, "is no STL file: it is too short");
    std::uint32_t announced = 0;
    std::memcpy(&announced, bytes.data() + 80, 4);
    const std::uint64_t held = (bytes.size() - kHeader) / kFacet;
    std::uint64_t count = announced;
    // Programs that do not know the number in advance leave it at 0 or at -1.
    if ((announced == 0 || announced == 0xffffffffu) && held > 0 && (bytes.size() - kHeader) % kFacet == 0) {
        count = held;
        warnings.add(fmt::format("{}: announces {} triangles, all {} that it has are read", file.filename().string(),
                                 announced, held));
    }
    if (count > held)
        fail(file, fmt::format("STL: announces {} triangles, has {} in its {} bytes (truncated?)", announced, held,
                               bytes.size()));
    if (count == 0) fail(file, "STL: no facets");
    if (count < held)
        warnings.add(fmt::format("{}: announces {} triangles; the {} that follow them are left out",
                                 file.filename().string(), announced, held - count));
    if (count > kNoIndex / 3) fail(file, "STL: more than 2^32 corners");
    PolygonFile content;
    content.single_precision = true;
    for (std::uint64_t i = 0; i < count; ++i) {
        const char* const at = bytes.data() + kHeader + i * kFacet + 12;  // after the normal
        for (std::size_t corner = 0; corner < 3; ++corner) {
            float p[3];
            std::memcpy(p, at + corner * sizeof p, sizeof p);
            content.corners.push_back({.position = std::uint32_t(content.positions.size())});
            content.positions.emplace_back(p[0], p[1], p[2]);
        }
        content.end_polygon();
    }
    return content;
}

}  // namespace

PolygonFile read_stl(const std::filesystem::path& file, std::vector<std::byte> bytes, Warnings& warnings) {
    static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");
    if (is_text(as_text(bytes))) return StlText(file, as_text(bytes)).read();
    std::vector<std::byte> decoded = bytes;
    make_utf8(decoded);
    if (decoded.size() != bytes.size() && is_text(as_text(decoded))) return StlText(file, as_text(decoded)).read();
    return read_binary(file, as_text(bytes), warnings);
}

}  // namespace pellucid
