#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// Type of a number in a PLY file.
struct PlyType {
    char kind = 0;  ///< i, u or f
    int size = 0;   ///< bytes: 1, 2, 4 or 8
};

struct PlyProperty {
    std::string name;
    PlyType type;  ///< of the value, or of the values of a list
    bool list = false;
    PlyType count_type;  ///< of a list's length
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;

    /// Index of the property of that name, -1 if there is none.
    int find(std::string_view property) const;
};

struct PlyHeader {
    bool ascii = false;
    bool big_endian = false;
    std::vector<PlyElement> elements;
    std::size_t size = 0;  ///< bytes up to the body
};

/// Throws Error naming `file` and the line.
PlyHeader read_ply_header(const std::filesystem::path& file, std::string_view text);

}  // namespace pellucid
