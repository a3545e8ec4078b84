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

/// A box of cubic voxels in which the index of refraction varies, and light is absorbed, scattered and emitted.
///
/// Voxel (x, y, z) is number `x + size.x (y + size.y z)`; its values stand at its middle, `low + voxel (x + 1/2, ...)` in the
/// volume's own frame, and are interpolated in between, media linearly. An empty field is that of vacuum: index 1, all else 0.
/// Light crosses the faces of the box straight on: what is outside goes on as the voxels at the face are.
struct Volume {
    std::string name;
    glm::uvec3 size{0};   ///< voxels, each >= 2
    glm::vec3 low{0.0f};  ///< corner of the box, m
    float voxel = 1.0f;   ///< edge of a voxel, m, > 0

    std::vector<float> n;              ///< index of refraction, > 0; of green where the colours differ
    std::vector<float> n_red, n_blue;  ///< both or neither; of dispersive media
    std::vector<glm::vec3> sigma_a;    ///< absorption, 1/m
    std::vector<glm::vec3> sigma_s;    ///< scattering, 1/m
    std::vector<float> g;              ///< mean cosine of scattering (Henyey & Greenstein), -1..1, both excluded
    std::vector<glm::vec3> emission;   ///< radiance that a metre adds, W/(m3 sr)
    std::vector<float> boundary;       ///< 0..1: where surfaces are that reflect (Fresnel), blurred as the index is

    std::size_t voxel_count() const { return std::size_t(size.x) * size.y * size.z; }
    glm::vec3 high() const { return low + voxel * glm::vec3(size); }
};

/// Throws Error naming the volume if a field's length is not that of the grid, or a number is not finite or out of range.
PELLUCID_API void check_volume(const Volume& volume);

/// Throws Error naming `what` if `size` voxels of `bytes_per_voxel` are more than the machine has free: before allocation
/// fails.
PELLUCID_API void check_volume_fits(const std::string& what, glm::uvec3 size, std::size_t bytes_per_voxel);

/// Smooths the index (all colours) and the boundary by a Gaussian of standard deviation `sigma` voxels, 0..16; outside the
/// box the voxels at its faces go on. 0 changes nothing.
PELLUCID_API void smooth_index(Volume& volume, float sigma);

/// Makes a volume: `NAME[,PARAMETER=VALUE...]` with names and parameters of volume_infos(). Throws Error in one line for
/// what is unknown, malformed, out of range, or does not fit into memory.
PELLUCID_API Volume make_volume(const std::string& spec);

/// Which field a grid of an OpenVDB file becomes.
struct GridMapping {
    std::string grid;
    /// n, n_red, n_blue, sigma_a, sigma_s, g, emission or boundary; a grid of numbers becomes a field of colours that are
    /// grey. Or distance: distances to a surface, positive outside, m, which is where the volume reflects; or level-set:
    /// the same, and bounds of a solid of index `scale`. Both are smoothed by 0.75 voxels.
    std::string field;
    float scale = 1.0f;  ///< factor on the grid's values
};

/// Loads an OpenVDB file: the grids that `mapping` names, or without one those that have the names of fields. Voxels must be
/// cubes along the axes. Throws Error naming the file, in one line, if it is missing, damaged, of other values than
/// float, double, vec3s or vec3d, or does not fit into memory.
PELLUCID_API Volume load_volume(const std::filesystem::path& file, std::span<const GridMapping> mapping = {});

struct VolumeFileOptions {
    bool double_precision = false;
    bool compress = true;  ///< by Blosc
};
/// Saves the fields as grids of their names. Throws Error if there are none or the file cannot be written.
PELLUCID_API void save_volume(const std::filesystem::path& file, const Volume& volume,
                              const VolumeFileOptions& options = {});

}  // namespace pellucid
