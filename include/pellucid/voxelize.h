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
    float smoothing = 0.75f;         ///< standard deviation of a Gaussian on the index, voxels, 0..16
    std::uint32_t samples = 8;       ///< samples along x and y of a voxel, 1..16; coverage along z is exact
    float scattering = 0.0f;         ///< scattering inside all objects, 1/m, >= 0
    float g = 0.0f;                  ///< mean cosine of scattering, -1..1, both excluded
    float noise = 0.0f;              ///< 0..1: noise scales absorption and scattering by 1 - noise..1 + noise
    float noise_scale = 0.0f;        ///< width of the noise, m; 0: a quarter of the box
    bool closed_only = false;        ///< an open mesh is an Error instead of a warning
};

struct VoxelizedScene {
    Volume volume;  ///< in world space
    std::vector<std::string> warnings;
};

/// Voxelizes the glass solids of a scene (Material::refractive) into one volume. Each solid contributes the index,
/// dispersion and absorption of its material. Of overlapping solids, the solid with the smaller box displaces the
/// other. `boundary` is 1 on their surfaces. Columns through holes of an open mesh stay empty, with a warning that
/// names the object, unless `closed_only`. Throws Error for settings out of range, for a scene without such objects,
/// or if the voxels do not fit into memory.
PELLUCID_API VoxelizedScene voxelize(const Scene& scene, const VoxelSettings& settings = {},
                                     const DeviceOptions& device = {});

}  // namespace pellucid
