// Walks through a PLY file as its header describes it (G. Turk, "The PLY Polygon File Format",
// 1994) without building anything.
#include "core/fail.h"
#include "scene/mesh_file_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <vector>

namespace pellucid {
namespace {

constexpr std::string_view kBlank = " \t\r\n\v\f";

struct Property {
    char type = 0;  ///< of the value: i u f, followed by the size in the next field
    int size = 0;   ///< bytes
    bool list = false;
    char count_type = 0;
    int count_size = 0;
    bool vertex_indices = false;
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

struct Header {
    bool ascii = false;
    bool big_endian = false;
    std::vector<Element> elements;
    std::size_t size = 0;  ///< bytes up to and including end_header's line break
    std::string plain;     ///< the same without comments, in the order that assimp insists on
};

bool parse_type(std::string_view name, char& type, int& size) {
    struct Name {
        std::string_view name;
        char type;
        int size;
    };
    static constexpr Name kNames[] = {{"char", 'i', 1},  {"int8", 'i', 1},    {"uchar", 'u', 1},  {"uint8", 'u', 1},
                                      {"short", 'i', 2}, {"int16", 'i', 2},   {"ushort", 'u', 2}, {"uint16", 'u', 2},
                                      {"int", 'i', 4},   {"int32", 'i', 4},   {"uint", 'u', 4},   {"uint32", 'u', 4},
                                      {"float", 'f', 4}, {"float32", 'f', 4}, {"double", 'f', 8}, {"float64", 'f', 8}};
    for (const Name& n : kNames) {
        if (n.name != name) continue;
        type = n.type;
        size = n.size;
        return true;
    }
    return false;
}

std::vector<std::string_view> words(std::string_view line) {
    std::vector<std::string_view> result;
    for (std::size_t at = line.find_first_not_of(kBlank); at != line.npos;) {
        const std::size_t end = std::min(line.find_first_of(kBlank, at), line.size());
        result.push_back(line.substr(at, end - at));
        at = line.find_first_not_of(kBlank, end);
    }
    return result;
}

Property parse_property(const std::filesystem::path& file, const std::vector<std::string_view>& w) {
    Property property;
    property.list = w.size() == 5 && w[1] == "list";
    const std::string_view type = property.list ? w[3] : w.size() == 3 ? w[1] : "";
    if (!parse_type(type, property.type, property.size) ||
        (property.list && !parse_type(w[2], property.count_type, property.count_size)) || property.count_type == 'f')
        fail(file, "PLY header: a property is malformed");
    property.vertex_indices = property.list && (w[4] == "vertex_indices" || w[4] == "vertex_index");
    if (property.vertex_indices && property.type == 'f') fail(file, "PLY header: vertex indices must be integers");
    return property;
}

Header parse_header(const std::filesystem::path& file, std::string_view text) {
    Header header;
    bool known_format = false;
    for (std::size_t line_number = 1; header.size < text.size(); ++line_number) {
        const std::size_t end = text.find_first_of("\r\n", header.size);
        if (end == text.npos) break;
        const std::vector<std::string_view> w = words(text.substr(header.size, end - header.size));
        header.size = end + 1;
        if (text[end] == '\r' && header.size < text.size() && text[header.size] == '\n') ++header.size;
        if (line_number == 1) {
            if (w.size() != 1 || w[0] != "ply") fail(file, "is no PLY file: it does not begin with \"ply\"");
        } else if (w.empty() || w[0] == "comment" || w[0] == "obj_info") {
            continue;
        } else if (w[0] == "format" && w.size() >= 2) {
            header.ascii = w[1] == "ascii";
            header.big_endian = w[1] == "binary_big_endian";
            known_format = header.ascii || header.big_endian || w[1] == "binary_little_endian";
            header.plain.insert(0, fmt::format("ply\nformat {} 1.0\n", w[1]));
        } else if (w[0] == "element" && w.size() == 3) {
            Element element{std::string(w[1]), 0, {}};
            const auto [last, error] = std::from_chars(w[2].data(), w[2].data() + w[2].size(), element.count);
            if (error != std::errc() || last != w[2].data() + w[2].size())
                fail(file, fmt::format("PLY header: count of element {} is no number", element.name));
            header.elements.push_back(std::move(element));
            header.plain += fmt::format("{}\n", fmt::join(w, " "));
        } else if (w[0] == "property" && !header.elements.empty()) {
            header.elements.back().properties.push_back(parse_property(file, w));
            header.plain += fmt::format("{}\n", fmt::join(w, " "));
        } else if (w[0] == "end_header") {
            if (!known_format) fail(file, "PLY header: unknown format");
            header.plain += "end_header\n";
            return header;
        } else {
            fail(file, fmt::format("PLY header: line {} is malformed", line_number));
        }
    }
    fail(file, "PLY header has no end_header");
}

/// Reads the values that follow the header, one after the other.
class Values {
public:
    Values(const std::filesystem::path& file, const Header& header, std::string_view body)
        : file_(file), header_(header), body_(body) {}

    void skip(std::uint64_t count, int size) {
        if (header_.ascii) {
            for (std::uint64_t i = 0; i < count; ++i) token();
        } else {
            need(count * static_cast<std::uint64_t>(size));
            at_ += count * static_cast<std::uint64_t>(size);
        }
    }

    std::int64_t integer(char type, int size) {
        if (header_.ascii) {
            const std::string_view t = token();
            std::int64_t value = 0;
            const auto [last, error] = std::from_chars(t.data(), t.data() + t.size(), value);
            if (error != std::errc() || last != t.data() + t.size())
                fail(file_, fmt::format("PLY: \"{}\" where an integer is expected", t.substr(0, 20)));
            return value;
        }
        need(static_cast<std::uint64_t>(size));
        std::uint64_t value = 0;
        for (int i = 0; i < size; ++i) {
            const int place = header_.big_endian ? size - 1 - i : i;
            value |= std::uint64_t(static_cast<unsigned char>(body_[at_ + std::size_t(i)])) << (8 * place);
        }
        at_ += static_cast<std::size_t>(size);
        const int unused = 64 - 8 * size;
        return type == 'i' ? std::int64_t(value << unused) >> unused : std::int64_t(value);
    }

    /// Binary files may be padded; more numbers than announced mean that the header is wrong.
    void expect_end() const {
        if (header_.ascii && body_.find_first_not_of(kBlank, at_) != body_.npos)
            fail(file_, "PLY: there is more data than the header announces");
    }

private:
    void need(std::uint64_t size) const {
        if (size > body_.size() - at_) fail(file_, "PLY: the file ends early (truncated?)");
    }

    std::string_view token() {
        const std::size_t begin = body_.find_first_not_of(kBlank, at_);
        if (begin == body_.npos) fail(file_, "PLY: the file ends early (truncated?)");
        at_ = std::min(body_.find_first_of(kBlank, begin), body_.size());
        return body_.substr(begin, at_ - begin);
    }

    const std::filesystem::path& file_;
    const Header& header_;
    std::string_view body_;
    std::size_t at_ = 0;
};

}  // namespace

std::uint64_t check_ply(const std::filesystem::path& file, std::vector<std::byte>& bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const Header header = parse_header(file, text);
    std::uint64_t vertices = 0, faces = 0;
    for (const Element& element : header.elements) {
        if (element.name == "vertex") vertices = element.count;
        if (element.name == "face") faces = element.count;
        // Every element takes at least one byte, so a longer count cannot be true.
        if (element.count > bytes.size())
            fail(file, fmt::format("PLY header: {} elements \"{}\" in a file of {} bytes", element.count, element.name,
                                   bytes.size()));
        if (element.count > 0 && element.properties.empty())
            fail(file, fmt::format("PLY header: element \"{}\" has no properties", element.name));
    }
    Values values(file, header, text.substr(header.size));
    for (const Element& element : header.elements) {
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (const Property& p : element.properties) {
                const std::int64_t count = p.list ? values.integer(p.count_type, p.count_size) : 1;
                if (count < 0) fail(file, fmt::format("PLY: {} {} has a negative length", element.name, i));
                if (!p.vertex_indices) {
                    values.skip(std::uint64_t(count), p.size);
                    continue;
                }
                for (std::int64_t k = 0; k < count; ++k) {
                    const std::int64_t index = values.integer(p.type, p.size);
                    if (index < 0 || std::uint64_t(index) >= vertices)
                        fail(file, fmt::format("PLY: {} {} refers to vertex {}, there are {}", element.name, i, index,
                                               vertices));
                }
            }
        }
    }
    values.expect_end();
    const auto* plain = reinterpret_cast<const std::byte*>(header.plain.data());
    std::vector<std::byte> rewritten(plain, plain + header.plain.size());
    rewritten.insert(rewritten.end(), bytes.begin() + std::ptrdiff_t(header.size), bytes.end());
    bytes = std::move(rewritten);
    return faces;
}

}  // namespace pellucid
