// Header of a PLY file (G. Turk, "The PLY Polygon File Format", 1994).
#include "scene/mesh_files/ply_header.h"

#include "core/fail.h"
#include "scene/mesh_files/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace pellucid {
namespace {

bool parse_type(std::string_view name, PlyType& type) {
    static constexpr std::pair<std::string_view, PlyType> kTypes[] = {
        {"char", {'i', 1}},    {"int8", {'i', 1}},   {"uchar", {'u', 1}},  {"uint8", {'u', 1}},  {"short", {'i', 2}},
        {"int16", {'i', 2}},   {"ushort", {'u', 2}}, {"uint16", {'u', 2}}, {"int", {'i', 4}},    {"int32", {'i', 4}},
        {"uint", {'u', 4}},    {"uint32", {'u', 4}}, {"int64", {'i', 8}},  {"uint64", {'u', 8}}, {"float", {'f', 4}},
        {"float32", {'f', 4}}, {"double", {'f', 8}}, {"float64", {'f', 8}}};
    const auto* const known =
        std::find_if(std::begin(kTypes), std::end(kTypes), [&](const auto& entry) { return entry.first == name; });
    if (known == std::end(kTypes)) return false;
    type = known->second;
    return true;
}

bool parse_property(Words& words, PlyProperty& property) {
    std::string_view type = words.next();
    property.list = type == "list";
    if (property.list) {
        if (!parse_type(words.next(), property.count_type) || property.count_type.kind == 'f') return false;
        type = words.next();
    }
    property.name = words.next();
    return parse_type(type, property.type) && !property.name.empty();
}

}  // namespace

int PlyElement::find(std::string_view property) const {
    const auto found =
        std::find_if(properties.begin(), properties.end(), [&](const auto& p) { return p.name == property; });
    return found == properties.end() ? -1 : int(found - properties.begin());
}

PlyHeader read_ply_header(const std::filesystem::path& file, std::string_view text) {
    PlyHeader header;
    bool known_format = false;
    // The first line says how lines end: a body may begin with any byte, such as a line feed.
    const std::size_t first_end = std::min(text.find_first_of("\r\n"), text.size());
    const bool carriage_return = text.substr(first_end, 1) == "\r" && text.substr(first_end, 2) != "\r\n";
    std::size_t line_number = 1;
    const auto malformed = [&](const std::string& cause) {
        fail(file, fmt::format("PLY header: line {}: {}", line_number, cause));
    };
    for (;; ++line_number) {
        const std::size_t end = text.find(carriage_return ? '\r' : '\n', header.size);
        const std::string_view line = text.substr(header.size, end == text.npos ? 0 : end - header.size);
        Words words(line);
        const std::string_view keyword = words.next();
        if (line_number == 1 && (keyword != "ply" || first_end == text.size()))
            fail(file, "is no PLY file: it does not begin with \"ply\"");
        if (end == text.npos) fail(file, "PLY header has no end_header");
        header.size = end + 1;
        if (line_number == 1 || keyword.empty() || keyword == "comment" || keyword == "obj_info") {
            continue;
        } else if (keyword == "format") {
            const std::string_view format = words.next();
            header.ascii = format == "ascii";
            header.big_endian = format == "binary_big_endian";
            known_format = header.ascii || header.big_endian || format == "binary_little_endian";
            if (!known_format) malformed(fmt::format("unknown format \"{}\"", shortened(format)));
        } else if (keyword == "element") {
            PlyElement element{std::string(words.next()), 0, {}};
            const std::string_view count = words.next();
            const std::optional<std::int64_t> number = parse_integer(count);
            if (!number || *number < 0)
                malformed(fmt::format("the number of elements \"{}\" is \"{}\"", element.name, shortened(count)));
            element.count = std::uint64_t(*number);
            header.elements.push_back(std::move(element));
        } else if (keyword == "property" && !header.elements.empty()) {
            PlyProperty property;
            if (!parse_property(words, property)) malformed("the property is malformed");
            header.elements.back().properties.push_back(std::move(property));
        } else if (keyword == "end_header") {
            if (!known_format) fail(file, "PLY header: there is no format");
            return header;
        } else {
            malformed(fmt::format("\"{}\" is unknown", shortened(keyword)));
        }
    }
}

}  // namespace pellucid
