#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace pellucid {

inline constexpr std::uint32_t kNoIndex = std::numeric_limits<std::uint32_t>::max();

/// Which entries of a PolygonFile a corner of a polygon refers to.
struct PolygonCorner {
    std::uint32_t position = 0;
    std::uint32_t texcoord = kNoIndex, normal = kNoIndex;  ///< kNoIndex: none
};

/// Content of a mesh file, as its format lists it. Readers check that all indices are in range; positions may be
/// any numbers.
struct PolygonFile {
    std::vector<glm::dvec3> positions;
    bool single_precision = false;   ///< positions are stored as 32-bit numbers
    std::uint32_t first_number = 0;  ///< by which the file refers to its first position
    std::vector<glm::vec3> normals;
    std::vector<glm::vec2> texcoords;  ///< v runs upwards
    std::vector<glm::vec4> colors;     ///< none, or one linear RGBA per position

    std::vector<PolygonCorner> corners;    ///< of all polygons, one polygon after the other
    std::vector<std::uint32_t> ends;       ///< per polygon, the end of its corners
    std::vector<std::uint32_t> materials;  ///< none, or per polygon an index into material_names, or kNoIndex
    std::vector<std::string> material_names;
    std::vector<std::string> libraries;  ///< names of material files, as the file has them

    std::uint64_t points = 0, lines = 0;  ///< elements that are no polygons

    /// Ends a polygon whose corners have been appended. One or two corners are a point or a line.
    void end_polygon(std::uint32_t material = kNoIndex) {
        const std::size_t begin = ends.empty() ? 0 : ends.back();
        const std::size_t count = corners.size() - begin;
        if (count < 3) {
            points += count == 1;
            lines += count == 2;
            corners.resize(begin);
            return;
        }
        ends.push_back(std::uint32_t(corners.size()));
        if (!material_names.empty()) {
            materials.resize(ends.size() - 1, kNoIndex);
            materials.push_back(material);
        }
    }
};

}  // namespace pellucid
