// PLY (G. Turk, "The PLY Polygon File Format", 1994), with the triangle strips of the Stanford 3D Scanning Repository.
#include "core/fail.h"
#include "scene/mesh_files/ply_header.h"
#include "scene/mesh_files/read_mesh_files.h"
#include "scene/mesh_files/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

namespace pellucid {
namespace {

/// The numbers that follow the header, one after the other.
class PlyBody {
public:
    PlyBody(const std::filesystem::path& file, const PlyHeader& header, std::string_view body)
        : file_(file), header_(header), body_(body), words_(body) {}

    double number(PlyType type) {
        if (header_.ascii) {
            const std::string_view text = word();
            const std::optional<double> value = parse_real(text);
            if (!value) fail_here(fmt::format("\"{}\" is no number", shortened(text)));
            return *value;
        }
        if (type.kind != 'f') return double(integer(type));
        const std::uint64_t bits = take(type.size);
        if (type.size == 8) {
            double value;
            std::memcpy(&value, &bits, sizeof value);
            return value;
        }
        const auto low = std::uint32_t(bits);
        float value;
        std::memcpy(&value, &low, sizeof value);
        return double(value);
    }

    std::int64_t integer(PlyType type) {
        if (header_.ascii || type.kind == 'f') {
            const double value = number(type);
            // Some programs write counts and indices with a decimal point.
            if (!(std::abs(value) < 9e18) || value != std::floor(value))
                fail_here(fmt::format("{} where a whole number is expected", value));
            return std::int64_t(value);
        }
        const std::uint64_t value = take(type.size);
        const int unused = 64 - 8 * type.size;
        return type.kind == 'i' ? std::int64_t(value << unused) >> unused : std::int64_t(value);
    }

    void skip(std::uint64_t count, PlyType type) {
        if (header_.ascii) {
            for (std::uint64_t i = 0; i < count; ++i) word();
        } else {
            need(count, type.size);
            at_ += count * std::uint64_t(type.size);
        }
    }

    /// Length of a list.
    std::uint64_t length(const PlyProperty& property) {
        const std::int64_t count = integer(property.count_type);
        if (count < 0) fail_here("a list has a negative length");
        need(std::uint64_t(count), header_.ascii ? 1 : property.type.size);
        return std::uint64_t(count);
    }

    void set_element(const PlyElement& element, std::uint64_t index) { element_ = &element, index_ = index; }

    [[noreturn]] void fail_here(const std::string& cause) const {
        fail(file_, fmt::format("PLY: {} {}: {}", element_->name, index_, cause));
    }

    /// Binary files may be padded; more numbers than announced mean that the header is wrong.
    void expect_end() {
        if (header_.ascii && !words_.next().empty()) fail(file_, "PLY: there is more data than the header announces");
    }

private:
    /// Every element takes at least `size` bytes, so that a count that exceeds the file cannot be true.
    void need(std::uint64_t count, int size) const {
        const std::size_t left = body_.size() - (header_.ascii ? words_.at() : at_);
        if (count > left / std::uint64_t(size)) fail_here("the file ends early (truncated?)");
    }

    std::uint64_t take(int size) {
        need(1, size);
        std::uint64_t value = 0;
        for (int i = 0; i < size; ++i) {
            const int place = header_.big_endian ? size - 1 - i : i;
            value |= std::uint64_t(static_cast<unsigned char>(body_[at_ + std::size_t(i)])) << (8 * place);
        }
        at_ += std::size_t(size);
        return value;
    }

    std::string_view word() {
        const std::string_view next = words_.next();
        if (next.empty()) fail_here("the file ends early (truncated?)");
        return next;
    }

    const std::filesystem::path& file_;
    const PlyHeader& header_;
    std::string_view body_;
    Words words_;
    std::size_t at_ = 0;
    const PlyElement* element_ = nullptr;
    std::uint64_t index_ = 0;
};

class PlyReader {
public:
    PlyReader(const std::filesystem::path& file, std::string_view text, Warnings& warnings)
        : file_(file), header_(read_ply_header(file, text)), body_(file, header_, text.substr(header_.size)),
          warnings_(warnings) {
        for (const PlyElement& element : header_.elements) {
            if (element.count > text.size())
                fail(file, fmt::format("PLY header: {} elements \"{}\" in a file of {} bytes", element.count,
                                       element.name, text.size()));
            if (element.count > 0 && element.properties.empty())
                fail(file, fmt::format("PLY header: element \"{}\" has no properties", element.name));
            if (element.name != "vertex") continue;
            if (vertices_ > 0) fail(file, "PLY header: there are two elements \"vertex\"");
            vertices_ = element.count;
        }
    }

    PolygonFile read() {
        for (const PlyElement& element : header_.elements) {
            if (element.name == "vertex") {
                read_vertices(element);
            } else if (element.name == "face" || element.name == "tristrips") {
                read_polygons(element, element.name == "tristrips");
            } else {
                skip(element);
            }
        }
        body_.expect_end();
        if (colored_)
            warnings_.add(
                fmt::format("{}: colours of vertices are not used: the file is glass", file_.filename().string()));
        return std::move(content_);
    }

private:
    void skip(const PlyElement& element) {
        for (std::uint64_t i = 0; i < element.count; ++i) {
            body_.set_element(element, i);
            for (const PlyProperty& p : element.properties) skip(p);
        }
        if (element.name == "edge") content_.lines += element.count;
    }

    void skip(const PlyProperty& property) { body_.skip(property.list ? body_.length(property) : 1, property.type); }

    void read_vertices(const PlyElement& element) {
        // Position and normal, by the number of the property.
        static constexpr std::array<std::string_view, 6> kNames = {"x", "y", "z", "nx", "ny", "nz"};
        std::array<int, 6> at{};
        std::transform(kNames.begin(), kNames.end(), at.begin(), [&](auto name) { return element.find(name); });
        if (element.count > 0 && *std::min_element(at.begin(), at.begin() + 3) < 0)
            fail(file_, "PLY header: vertices have no x, y and z");
        for (const int property : at)
            if (property >= 0 && element.properties[std::size_t(property)].list)
                fail(file_, "PLY header: coordinates of vertices are lists");
        const bool normals = *std::min_element(at.begin() + 3, at.end()) >= 0;
        for (const char* name : {"red", "diffuse_red", "r"}) colored_ = colored_ || element.find(name) >= 0;
        content_.single_precision =
            !header_.ascii && element.count > 0 && element.properties[std::size_t(at[0])].type.size <= 4;
        std::vector<int> wanted(element.properties.size(), -1);
        for (std::size_t k = 0; k < (normals ? 6u : 3u); ++k)
            if (at[k] >= 0) wanted[std::size_t(at[k])] = int(k);
        for (std::uint64_t i = 0; i < element.count; ++i) {
            body_.set_element(element, i);
            std::array<double, 6> values{};
            for (std::size_t p = 0; p < wanted.size(); ++p) {
                if (wanted[p] < 0) {
                    skip(element.properties[p]);
                } else {
                    values[std::size_t(wanted[p])] = body_.number(element.properties[p].type);
                }
            }
            content_.positions.emplace_back(values[0], values[1], values[2]);
            if (!normals) continue;
            const glm::vec3 normal(values[3], values[4], values[5]);
            content_.normals.push_back(std::isfinite(normal.x + normal.y + normal.z) ? normal : glm::vec3(0.0f));
        }
    }

    void read_polygons(const PlyElement& element, bool strips) {
        int list = std::max(element.find("vertex_indices"), element.find("vertex_index"));
        for (std::size_t p = 0; list < 0 && p < element.properties.size(); ++p)
            if (element.properties[p].list && element.properties[p].type.kind != 'f') list = int(p);
        if (list < 0 || !element.properties[std::size_t(list)].list) {
            if (element.count > 0)
                fail(file_, fmt::format("PLY header: element \"{}\" has no list vertex_indices", element.name));
            return;
        }
        if (element.properties[std::size_t(list)].type.kind == 'f')
            fail(file_, "PLY header: vertex indices must be integers");
        std::vector<std::int64_t> indices;
        for (std::uint64_t i = 0; i < element.count; ++i) {
            body_.set_element(element, i);
            for (std::size_t p = 0; p < element.properties.size(); ++p) {
                const PlyProperty& property = element.properties[p];
                if (int(p) != list) {
                    skip(property);
                    continue;
                }
                indices.resize(body_.length(property));
                for (std::int64_t& index : indices) index = body_.integer(property.type);
                strips ? add_strips(indices) : add_polygon(indices);
            }
        }
    }

    void add_polygon(const std::vector<std::int64_t>& indices) {
        for (const std::int64_t index : indices) add_corner(index);
        content_.end_polygon();
    }

    /// Every index but the first two of a strip makes a triangle with the two before it, with alternate winding; -1
    /// starts the next strip.
    void add_strips(const std::vector<std::int64_t>& indices) {
        std::size_t start = 0;
        for (std::size_t i = 0; i < indices.size(); ++i) {
            if (indices[i] == -1) {
                start = i + 1;
            } else if (i >= start + 2) {
                const bool odd = (i - start) % 2 != 0;
                for (const std::size_t k : {odd ? i - 1 : i - 2, odd ? i - 2 : i - 1, i}) add_corner(indices[k]);
                content_.end_polygon();
            }
        }
    }

    void add_corner(std::int64_t index) {
        if (index < 0 || std::uint64_t(index) >= vertices_)
            body_.fail_here(fmt::format("refers to vertex {}, there are {}", index, vertices_));
        if (content_.corners.size() >= kNoIndex - 1) body_.fail_here("more than 2^32 corners");
        content_.corners.push_back({.position = std::uint32_t(index), .normal = std::uint32_t(index)});
    }

    const std::filesystem::path& file_;
    PlyHeader header_;
    PlyBody body_;
    Warnings& warnings_;
    PolygonFile content_;
    std::uint64_t vertices_ = 0;
    bool colored_ = false;
};

}  // namespace

PolygonFile read_ply(const std::filesystem::path& file, std::vector<std::byte> bytes, Warnings& warnings) {
    make_utf8(bytes);
    PolygonFile content = PlyReader(file, as_text(bytes), warnings).read();
    if (content.normals.empty())
        for (PolygonCorner& corner : content.corners) corner.normal = kNoIndex;
    return content;
}

}  // namespace pellucid
