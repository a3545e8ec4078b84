#pragma once

#include <pellucid/api.h>
#include <pellucid/device.h>
#include <pellucid/scene.h>
#include <pellucid/volume.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pellucid {

struct VoxelSettings {
    std::uint32_t resolution = 128;  ///< voxels along the longest side of the box, 8..65536
    float smoothing = 0.75f;         ///< of the index: standard deviation of a Gaussian, voxels, 0..16
    std::uint32_t samples = 8;       ///< along x and y of a voxel, 1..16; along z its coverage is exact
    float scattering = 0.0f;         ///< inside all objects, 1/m, >= 0
    float g = 0.0f;                  ///< mean cosine of that, -1..1, both excluded
    float noise = 0.0f;              ///< 0..1: share of absorption and scattering that noise takes away or doubles
    float noise_scale = 0.0f;        ///< width of the noise, m; 0: a quarter of the box
    bool closed_only = false;        ///< an open mesh is an Error, instead of a warning
};

struct VoxelizedScene {
    Volume volume;  ///< in the world's frame
    std::vector<std::string> warnings;
};

/// Makes one volume of the solids of glass of a scene (Material::refractive), each with the index, dispersion and absorption
/// of its material; where they overlap, the one with the smaller box displaces the other. `boundary` is 1 on their surfaces.
/// Columns of an open mesh that go through its holes are left empty, with a warning that names the object, unless
/// `closed_only`. Throws Error for settings out of range, if there are no such objects, or if the voxels do not fit into memory.
PELLUCID_API VoxelizedScene voxelize(const Scene& scene, const VoxelSettings& settings = {},
                                     const DeviceOptions& device = {});

}  // namespace pellucid
