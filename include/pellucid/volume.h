#pragma once

#include <pellucid/api.h>

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace pellucid {

/// A box of cubic voxels with varying index of refraction, absorption, scattering and emission.
///
/// Voxel (x, y, z) has index `x + size.x (y + size.y z)`. Its values apply at its centre, `low + voxel (x + 1/2, ...)`
/// in the volume's own frame, and are interpolated in between, media linearly. An empty field is that of vacuum: index
/// 1, all else 0. Light crosses the faces of the box unbent, as if the index at the face continued outside.
struct Volume {
    std::string name;
    glm::uvec3 size{0};   ///< voxels, each >= 2
    glm::vec3 low{0.0f};  ///< corner of the box, m
    float voxel = 1.0f;   ///< edge of a voxel, m, > 0

    std::vector<float> n;              ///< index of refraction, > 0; for green in dispersive media
    std::vector<float> n_red, n_blue;  ///< index for red and blue in dispersive media; set both or neither
    std::vector<glm::vec3> sigma_a;    ///< absorption, 1/m
    std::vector<glm::vec3> sigma_s;    ///< scattering, 1/m
    std::vector<float> g;              ///< mean cosine of scattering (Henyey & Greenstein), -1..1, both excluded
    std::vector<glm::vec3> emission;   ///< radiance added per metre, W/(m3 sr)
    std::vector<float> boundary;       ///< 0..1: reflecting surfaces (Fresnel), blurred like the index

    std::size_t voxel_count() const { return std::size_t(size.x) * size.y * size.z; }
    glm::vec3 high() const { return low + voxel * glm::vec3(size); }
};

/// Throws Error naming the volume if a field's length differs from the grid's, or a number is not finite or out of
/// range.
PELLUCID_API void check_volume(const Volume& volume);

/// Throws Error naming `what` if `size` voxels of `bytes_per_voxel` exceed the machine's free memory, before an
/// allocation fails.
PELLUCID_API void check_volume_fits(const std::string& what, glm::uvec3 size, std::size_t bytes_per_voxel);

/// Smooths the index (all colours) and the boundary by a Gaussian of standard deviation `sigma` voxels, 0..16. Voxels
/// at the box's faces continue outside. 0 changes nothing.
PELLUCID_API void smooth_index(Volume& volume, float sigma);

/// Creates a volume from `NAME[,PARAMETER=VALUE...]` with names and parameters of volume_infos(). Throws Error in one
/// line for unknown, malformed or out-of-range input, or if the volume does not fit into memory.
PELLUCID_API Volume make_volume(const std::string& spec);

/// Assignment of an OpenVDB grid to a field.
struct GridMapping {
    std::string grid;
    /// n, n_red, n_blue, sigma_a, sigma_s, g, emission or boundary. A scalar grid becomes a grey colour field.
    /// `distance`: signed distances to a reflecting surface in m, positive outside. `level-set`: the same distances,
    /// which also bound a solid of index `scale`. Both are smoothed by 0.75 voxels.
    std::string field;
    float scale = 1.0f;  ///< factor on the grid's values
};

/// Loads the grids in `mapping` from an OpenVDB file, or if `mapping` is empty, the grids named like fields. Voxels
/// must be cubes along the axes. Throws Error naming the file, in one line, if it is missing, damaged or does not fit
/// into memory. Also throws Error if values are not float, double, vec3s or vec3d.
PELLUCID_API Volume load_volume(const std::filesystem::path& file, std::span<const GridMapping> mapping = {});

struct VolumeFileOptions {
    bool double_precision = false;
    bool compress = true;  ///< compress by Blosc
};
/// Saves each field as a grid of the same name. Throws Error if the volume has no fields or the file cannot be
/// written.
PELLUCID_API void save_volume(const std::filesystem::path& file, const Volume& volume,
                              const VolumeFileOptions& options = {});

}  // namespace pellucid
