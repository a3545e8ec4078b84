#pragma once

#include "core/math.h"
#include "scene/shapes/shape_arguments.h"

#include <pellucid/volume.h>

#include <functional>

namespace pellucid {

// Building blocks of volumes; volume_makers.cpp contains the table of names and parameters.

/// Calls `slice(z)` for every layer of voxels, from several threads.
void for_each_slice(const Volume& volume, const std::function<void(unsigned z)>& slice);

/// Centre of a voxel in the volume's frame, m.
glm::dvec3 voxel_center(const Volume& volume, unsigned x, unsigned y, unsigned z);

/// An empty grid over a box, with `resolution` voxels along its longest side. Throws Error if `fields` floats per
/// voxel do not fit into memory.
Volume empty_grid(glm::dvec3 low, glm::dvec3 high, int resolution, std::size_t fields);

/// Fills a field with `value(x)` at the centre of every voxel.
template <class T, class Value>
void fill_field(const Volume& volume, std::vector<T>& field, const Value& value) {
    field.resize(volume.voxel_count());
    for_each_slice(volume, [&](unsigned z) {
        std::size_t i = std::size_t(z) * volume.size.x * volume.size.y;
        for (unsigned y = 0; y < volume.size.y; ++y)
            for (unsigned x = 0; x < volume.size.x; ++x) field[i++] = T(value(voxel_center(volume, x, y, z)));
    });
}

/// Noise with mean about 1/2, 0..1: octaves of smoothly interpolated random numbers on lattices (value noise). The
/// first octave has spacing `scale`, m; each further octave has half the spacing and half the weight.
double fractal_noise(glm::dvec3 x, double scale, int octaves = 5);

/// Factor of a medium for noise of value 0..1, within 1 - share..1 + share.
float noise_factor(double share, double value);

/// Converts a signed distance (m, positive outside) into the index, boundary and medium of a solid. `arguments`
/// contains the parameters of with_solid_parameters().
void fill_solid(Volume& volume, const ShapeArguments& arguments, const std::function<double(glm::dvec3)>& distance);

/// Appends the parameters of fill_solid(), and resolution, to a volume's own.
std::vector<ShapeParameter> with_solid_parameters(std::vector<ShapeParameter> own);

Volume make_luneburg(const ShapeArguments& arguments);
Volume make_maxwell_fisheye(const ShapeArguments& arguments);
Volume make_linear(const ShapeArguments& arguments);
Volume make_smoothed_sphere(const ShapeArguments& arguments);
Volume make_rounded_cube(const ShapeArguments& arguments);
Volume make_wine_glass(const ShapeArguments& arguments);
Volume make_mirage(const ShapeArguments& arguments);
Volume make_smoke(const ShapeArguments& arguments);

}  // namespace pellucid
