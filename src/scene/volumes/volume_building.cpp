#include "scene/volumes/volume_building.h"

#include "optics/index_fields.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

namespace pellucid {
namespace {

/// Pseudo-random number 0..1 of a lattice point, by the constants of xxHash's finalisation.
double lattice_number(glm::ivec3 at) {
    std::uint32_t h =
        std::uint32_t(at.x) * 0x9e3779b1u ^ std::uint32_t(at.y) * 0x85ebca77u ^ std::uint32_t(at.z) * 0xc2b2ae3du;
    h = (h ^ h >> 15) * 0x85ebca77u;
    h = (h ^ h >> 13) * 0xc2b2ae3du;
    return double(h ^ h >> 16) / 4294967295.0;
}

double value_noise(glm::dvec3 x) {
    const glm::dvec3 corner = glm::floor(x), f = x - corner;
    const glm::dvec3 w = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    double sum = 0.0;
    for (int k = 0; k < 8; ++k) {
        const glm::ivec3 offset(k & 1, k >> 1 & 1, k >> 2);
        const glm::dvec3 share = glm::mix(1.0 - w, w, glm::dvec3(offset));
        sum += share.x * share.y * share.z * lattice_number(glm::ivec3(corner) + offset);
    }
    return sum;
}

}  // namespace

void for_each_slice(const Volume& volume, const std::function<void(unsigned z)>& slice) {
    std::atomic<unsigned> next{0};
    const auto work = [&] {
        for (unsigned z = next++; z < volume.size.z; z = next++) slice(z);
    };
    std::vector<std::jthread> threads;
    for (unsigned i = 1; i < std::max(std::thread::hardware_concurrency(), 1u); ++i) threads.emplace_back(work);
    work();
}

glm::dvec3 voxel_center(const Volume& volume, unsigned x, unsigned y, unsigned z) {
    return glm::dvec3(volume.low) + double(volume.voxel) * (glm::dvec3(x, y, z) + 0.5);
}

Volume empty_grid(glm::dvec3 low, glm::dvec3 high, int resolution, std::size_t fields) {
    const glm::dvec3 extent = high - low;
    const double voxel = std::max({extent.x, extent.y, extent.z}) / resolution;
    Volume volume;
    volume.size = glm::max(glm::uvec3(glm::ceil(extent / voxel - 1e-6)), glm::uvec3(2));
    volume.voxel = float(voxel);
    volume.low = glm::vec3(0.5 * (low + high) - 0.5 * voxel * glm::dvec3(volume.size));
    check_volume_fits("volume", volume.size, fields * sizeof(float));
    return volume;
}

double fractal_noise(glm::dvec3 x, double scale, int octaves) {
    double sum = 0.0, weight = 1.0, total = 0.0;
    for (int octave = 0; octave < octaves; ++octave, weight *= 0.5) {
        // Offset the lattice of every octave, so that they share no corner.
        sum += weight * value_noise(x * std::exp2(octave) / scale + 17.31 * octave);
        total += weight;
    }
    return sum / total;
}

float noise_factor(double share, double value) {
    // The sum of octaves concentrates around the middle; double its deviation to fill the range.
    return float(1.0 + share * std::clamp(2.0 * (2.0 * value - 1.0), -1.0, 1.0));
}

std::vector<ShapeParameter> with_solid_parameters(std::vector<ShapeParameter> own) {
    const std::vector<ShapeParameter> common = {
        {"resolution", 128, 4, 65536, "voxels along the longest side of the box"},
        {"ior", 1.5, 0.1, 4, "index of refraction"},
        {"dispersion", 0, 0, 20, "20 / Abbe number; 0: all colours alike"},
        {"smoothing", 0.75, 0.25, 16, "standard deviation of the Gaussian that smooths the surface, voxels"},
        {"red", 0, 0, 1e6, "absorption of red light, 1/m"},
        {"green", 0, 0, 1e6, "absorption of green light, 1/m"},
        {"blue", 0, 0, 1e6, "absorption of blue light, 1/m"},
        {"scattering", 0, 0, 1e6, "scattering, 1/m"},
        {"g", 0, -0.99, 0.99, "mean cosine of scattering"},
        {"emitted-red", 0, 0, 1e6, "radiance of red light that a metre adds, W/(m3 sr)"},
        {"emitted-green", 0, 0, 1e6, "of green light"},
        {"emitted-blue", 0, 0, 1e6, "of blue light"},
        {"noise", 0, 0, 1, "share of absorption, scattering and emission that noise takes away or doubles"},
        {"noise-scale", 0.4, 0.001, 100, "width of the noise, m"},
    };
    own.insert(own.end(), common.begin(), common.end());
    return own;
}

void fill_solid(Volume& volume, const ShapeArguments& arguments, const std::function<double(glm::dvec3)>& distance) {
    const double sigma = arguments.number("smoothing") * double(volume.voxel);
    std::vector<float> inside;
    fill_field(volume, inside, [&](glm::dvec3 x) { return smoothed_inside(distance(x), sigma); });
    volume.boundary.resize(inside.size());
    // The smoothed Dirac delta is the slope of the smoothed inside, scaled to a height of 1.
    for_each_slice(volume, [&](unsigned z) {
        const std::size_t slice = std::size_t(volume.size.x) * volume.size.y;
        for (unsigned y = 0; y < volume.size.y; ++y)
            for (unsigned x = 0; x < volume.size.x; ++x) {
                const double d = distance(voxel_center(volume, x, y, z)) / sigma;
                volume.boundary[z * slice + std::size_t(y) * volume.size.x + x] = float(std::exp(-0.5 * d * d));
            }
    });
    const Vec3<double> iors = ior_per_channel(arguments.number("ior"), arguments.number("dispersion"));
    const auto index = [&](double ior) {
        std::vector<float> n(inside.size());
        std::transform(inside.begin(), inside.end(), n.begin(),
                       [&](float share) { return float(1.0 + (ior - 1.0) * double(share)); });
        return n;
    };
    volume.n = index(iors.y);
    if (arguments.number("dispersion") > 0.0) volume.n_red = index(iors.x), volume.n_blue = index(iors.z);

    const glm::vec3 absorption(float(arguments.number("red")), float(arguments.number("green")),
                               float(arguments.number("blue")));
    const glm::vec3 emission(float(arguments.number("emitted-red")), float(arguments.number("emitted-green")),
                             float(arguments.number("emitted-blue")));
    const double noise = arguments.number("noise"), scale = arguments.number("noise-scale");
    const auto scattering = float(arguments.number("scattering"));
    if (absorption == glm::vec3(0.0f) && scattering == 0.0f && emission == glm::vec3(0.0f)) return;
    std::vector<float> density;
    fill_field(volume, density, [&](glm::dvec3 x) {
        return distance(x) > 4.0 * sigma ? 0.0
               : noise == 0.0            ? 1.0
                                         : double(noise_factor(noise, fractal_noise(x, scale)));
    });
    for (std::size_t i = 0; i < density.size(); ++i) density[i] *= inside[i];
    const auto scaled = [&](glm::vec3 factor, std::vector<glm::vec3>& field) {
        field.resize(density.size());
        std::transform(density.begin(), density.end(), field.begin(), [&](float d) { return d * factor; });
    };
    if (absorption != glm::vec3(0.0f)) scaled(absorption, volume.sigma_a);
    if (emission != glm::vec3(0.0f)) scaled(emission, volume.emission);
    if (scattering > 0.0f) {
        scaled(glm::vec3(scattering), volume.sigma_s);
        volume.g.assign(density.size(), float(arguments.number("g")));
    }
}

}  // namespace pellucid
