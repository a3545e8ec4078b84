#pragma once

#include "core/file_scope.h"
#include "scene/warnings.h"

#include <glm/glm.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pellucid {

/// A texture of an MTL material. Texture coordinates are scaled, then moved, with v upwards.
struct MtlTexture {
    std::string name;            ///< as the material file has it; empty: there is no texture
    std::filesystem::path file;  ///< empty: there is none, because of `problem`
    std::string problem = "no such file";
    glm::vec2 scale{1.0f}, offset{0.0f};
    bool clamp = false;
    float bump = 1.0f;  ///< -bm; multiplies heights
};

/// A material of an MTL file; members have the names of its statements.
struct MtlMaterial {
    std::string name;
    std::optional<glm::vec3> Kd, Ks, Ke, Tf;
    std::optional<float> Ns, Ni, d, Pr, Pm;
    std::optional<int> illum;
    MtlTexture map_Kd, map_d, map_Ke, map_Pr, map_Pm, normal;
    MtlTexture bump;                  ///< heights, or normals: Blender writes those as map_Bump
    std::vector<std::string> unused;  ///< statements that would change the picture and are not read
};

/// Reads a material file. What is malformed is left out with a warning that names file and line.
/// Throws Error if the file cannot be read.
std::vector<MtlMaterial> read_mtl(const std::filesystem::path& file, const FileScope& scope, Warnings& warnings);

/// The file of that name as another one in `folder` writes it: with slashes or backslashes, in quotes, in other letter
/// case, or with a path from another computer, of which then the name counts. Empty if there is no such regular file.
/// Throws Error if there is one that `scope` does not allow.
std::filesystem::path find_beside(const std::filesystem::path& folder, std::string_view name, const FileScope& scope);

}  // namespace pellucid
