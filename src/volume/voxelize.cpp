// Volumes from meshes: Ihrke et al., "Eikonal rendering: efficient light transport in refractive objects", 2007,
// section 5.1.
#include "volume/voxelize.h"

#include "core/fail.h"
#include "core/parallel.h"
#include "gpu/device.h"
#include "optics/interface.h"
#include "scene/check_scene.h"
#include "scene/mesh_repair.h"
#include "scene/volumes/volume_building.h"
#include "volume/mesh_coverage.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid {
namespace {

struct Box {
    glm::dvec3 low{1e300}, high{-1e300};

    void add(const glm::dvec3& p) { low = glm::min(low, p), high = glm::max(high, p); }
    double content() const { return (high.x - low.x) * (high.y - low.y) * (high.z - low.z); }
};

struct Solid {
    const Object* object;
    Box box;
};

void check_settings(const VoxelSettings& s) {
    const auto require = [](bool holds, const std::string& what) {
        if (!holds) throw Error(what);
    };
    require(s.resolution >= 8 && s.resolution <= 65536,
            fmt::format("resolution must be 8 to 65536 voxels, not {}", s.resolution));
    require(s.smoothing >= 0.0f && s.smoothing <= 16.0f,
            fmt::format("smoothing must be 0 to 16 voxels, not {}", s.smoothing));
    require(s.samples >= 1 && s.samples <= 16, fmt::format("samples must be 1 to 16, not {}", s.samples));
    require(s.scattering >= 0.0f && s.scattering <= 1e6f,
            fmt::format("scattering must be 0 to 1e6 1/m, not {}", s.scattering));
    require(s.g > -1.0f && s.g < 1.0f, fmt::format("g must be between -1 and 1, not {}", s.g));
    require(s.noise >= 0.0f && s.noise <= 1.0f, fmt::format("noise must be 0 to 1, not {}", s.noise));
    require(s.noise_scale >= 0.0f && std::isfinite(s.noise_scale),
            fmt::format("the noise's scale must not be negative, not {}", s.noise_scale));
}

/// Solids of glass, the largest box first.
std::vector<Solid> solids_of(const Scene& scene) {
    std::vector<Solid> solids;
    for (const Object& object : scene.objects) {
        if (!scene.materials[std::size_t(object.material)].refractive()) continue;
        Box box;
        const glm::dmat4 world(object.world_from_object);
        for (const glm::vec3 p : scene.meshes[std::size_t(object.mesh)].positions)
            box.add(glm::dvec3(world * glm::dvec4(p, 1.0)));
        solids.push_back({&object, box});
    }
    if (solids.empty()) throw Error(fmt::format("{}: has no solids of glass to voxelise", one_line(scene.source)));
    std::stable_sort(solids.begin(), solids.end(),
                     [](const Solid& a, const Solid& b) { return a.box.content() > b.box.content(); });
    return solids;
}

class Voxelizer {
public:
    Voxelizer(const Device& device, const Scene& scene, const VoxelSettings& settings)
        : workspace_(device), scene_(scene), settings_(settings), solids_(solids_of(scene)) {}

    VoxelizedScene make() {
        make_grid();
        std::vector<float> boundary(volume_.voxel_count(), 0.0f);
        for (const Solid& solid : solids_) {
            check_closed(*solid.object);
            const glm::dmat4 grid_from_world = glm::scale(glm::dmat4(1.0), glm::dvec3(1.0 / double(volume_.voxel))) *
                                               glm::translate(glm::dmat4(1.0), -glm::dvec3(volume_.low));
            std::vector<float> coverage = mesh_coverage(
                workspace_, volume_, scene_.meshes[std::size_t(solid.object->mesh)],
                glm::mat4(grid_from_world * glm::dmat4(solid.object->world_from_object)), settings_.samples);
            fill(scene_.materials[std::size_t(solid.object->material)], coverage);
            add_boundary(std::move(coverage), boundary);
        }
        smooth_index(volume_, settings_.smoothing);
        volume_.boundary = std::move(boundary);
        if (settings_.noise > 0.0f) add_noise();
        return {std::move(volume_), std::move(warnings_)};
    }

private:
    const Material& material(const Solid& solid) const { return scene_.materials[std::size_t(solid.object->material)]; }

    /// Sets up the grid: the box of all solids, plus a margin for smoothing.
    void make_grid() {
        Box box;
        bool dispersive = false, absorbs = false;
        for (const Solid& solid : solids_) {
            box.add(solid.box.low);
            box.add(solid.box.high);
            dispersive = dispersive || material(solid).dispersion > 0.0f;
            absorbs = absorbs || material(solid).sigma_a() != glm::vec3(0.0f);
        }
        const glm::dvec3 extent = box.high - box.low;
        const double longest = std::max({extent.x, extent.y, extent.z});
        const double margin = std::ceil(3.0 * double(settings_.smoothing)) + 2.0;
        const double inner = settings_.resolution - 2.0 * margin;
        if (inner < 2.0)
            throw Error(
                fmt::format("{} voxels leave no room for {} at either side, which smoothing needs; take a higher "
                            "resolution",
                            settings_.resolution, margin));
        const double voxel = longest / inner;
        volume_.name = std::filesystem::path(scene_.source).stem().string();
        volume_.voxel = float(voxel);
        volume_.size = glm::uvec3(glm::ceil(extent / voxel - 1e-6) + 2.0 * margin);
        volume_.low = glm::vec3(0.5 * (box.low + box.high) - 0.5 * voxel * glm::dvec3(volume_.size));
        const std::size_t scatters = settings_.scattering > 0.0f ? 1 : 0;
        // Count the floats per voxel: index, boundary, coverage, its smoothed copy, and media.
        const std::size_t numbers = 4 + (dispersive ? 2 : 0) + (absorbs ? 3 : 0) + 4 * scatters;
        check_volume_fits(scene_.source, volume_.size, numbers * sizeof(float));
        const std::size_t count = volume_.voxel_count();
        volume_.n.assign(count, 1.0f);
        if (dispersive) volume_.n_red.assign(count, 1.0f), volume_.n_blue.assign(count, 1.0f);
        if (absorbs) volume_.sigma_a.assign(count, glm::vec3(0.0f));
        if (scatters) {
            volume_.sigma_s.assign(count, glm::vec3(0.0f));
            volume_.g.assign(count, settings_.g);
        }
    }

    void check_closed(const Object& object) {
        const Mesh& mesh = scene_.meshes[std::size_t(object.mesh)];
        if (count_edges(mesh.triangles, weld_positions(mesh.positions)).closed()) return;
        if (settings_.closed_only)
            throw Error(
                one_line(fmt::format("{}: object {}: its mesh is not closed, so that it has no inside; close it",
                                     scene_.source, object.name)));
        warnings_.push_back(one_line(fmt::format(
            "object {}: its mesh is not closed; columns of voxels through its holes are left empty", object.name)));
    }

    /// Fills a solid with its material, which displaces earlier materials in proportion to the coverage.
    void fill(const Material& material, const std::vector<float>& coverage) {
        const Vec3<double> ior = ior_per_channel(double(material.ior), double(material.dispersion));
        const auto displace = [&](auto& field, const auto& value) {
            if (field.empty()) return;
            for_each_parallel(volume_.size.z, [&](std::size_t z) {
                const std::size_t slice = std::size_t(volume_.size.x) * volume_.size.y;
                for (std::size_t i = z * slice; i < (z + 1) * slice; ++i)
                    if (coverage[i] > 0.0f) field[i] += coverage[i] * (value - field[i]);
            });
        };
        displace(volume_.n, float(ior.y));
        displace(volume_.n_red, float(ior.x));
        displace(volume_.n_blue, float(ior.z));
        displace(volume_.sigma_a, material.sigma_a());
        displace(volume_.sigma_s, glm::vec3(settings_.scattering));
    }

    /// Adds the boundary of a solid: the slope of its smoothed coverage, relative to that of a plane through the
    /// voxel's centre. Surfaces of larger solids vanish inside it.
    void add_boundary(std::vector<float> coverage, std::vector<float>& boundary) {
        Volume inside;
        inside.size = volume_.size;
        inside.n = std::move(coverage);
        smooth_index(inside, settings_.smoothing);
        const std::vector<float>& c = inside.n;
        // Variances add up: those of the Gaussian, of a voxel's width and of the central difference.
        const double variance = double(settings_.smoothing) * double(settings_.smoothing) + 1.0 / 12.0 + 1.0 / 3.0;
        const float scale = float(0.5 * std::sqrt(2.0 * std::numbers::pi * variance));
        const glm::uvec3 size = volume_.size;
        const std::size_t step_y = size.x, step_z = step_y * size.y;
        for_each_parallel(size.z, [&](std::size_t z) {
            if (z == 0 || z + 1 == size.z) return;
            for (std::size_t y = 1; y + 1 < size.y; ++y)
                for (std::size_t x = 1; x + 1 < size.x; ++x) {
                    const std::size_t i = x + step_y * y + step_z * z;
                    const glm::vec3 slope(c[i + 1] - c[i - 1], c[i + step_y] - c[i - step_y],
                                          c[i + step_z] - c[i - step_z]);
                    const float own = std::min(scale * glm::length(slope), 1.0f);
                    boundary[i] = std::max(boundary[i] * (1.0f - c[i]), own);
                }
        });
    }

    void add_noise() {
        const glm::vec3 extent = volume_.voxel * glm::vec3(volume_.size);
        const double scale = settings_.noise_scale > 0.0f ? double(settings_.noise_scale)
                                                          : 0.25 * double(std::max({extent.x, extent.y, extent.z}));
        for_each_slice(volume_, [&](unsigned z) {
            std::size_t i = std::size_t(z) * volume_.size.x * volume_.size.y;
            for (unsigned y = 0; y < volume_.size.y; ++y)
                for (unsigned x = 0; x < volume_.size.x; ++x, ++i) {
                    if (volume_.n[i] == 1.0f) continue;
                    const double value = fractal_noise(voxel_center(volume_, x, y, z), scale);
                    const auto factor = float(1.0 + double(settings_.noise) * std::clamp(4.0 * value - 2.0, -1.0, 1.0));
                    if (!volume_.sigma_a.empty()) volume_.sigma_a[i] *= factor;
                    if (!volume_.sigma_s.empty()) volume_.sigma_s[i] *= factor;
                }
        });
    }

    Workspace workspace_;
    const Scene& scene_;
    const VoxelSettings& settings_;
    std::vector<Solid> solids_;
    Volume volume_;
    std::vector<std::string> warnings_;
};

}  // namespace

VoxelizedScene voxelize(const Device& device, const Scene& scene, const VoxelSettings& settings) {
    check_settings(settings);
    check_scene(scene);
    return Voxelizer(device, scene, settings).make();
}

VoxelizedScene voxelize(const Scene& scene, const VoxelSettings& settings, const DeviceOptions& options) {
    check_settings(settings);
    const Device device(options);
    return voxelize(device, scene, settings);
}

}  // namespace pellucid
