// Volumes from implicit functions: lenses with known rays, solids by distance functions, air and smoke.
#include "optics/index_fields.h"
#include "scene/volumes/volume_building.h"

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

/// Samples an index field over a box of half-size `half`, smoothed by the parameter `smoothing`.
template <class Field>
Volume sampled(const Field& field, glm::dvec3 half, const ShapeArguments& arguments) {
    Volume volume = empty_grid(-half, half, arguments.whole("resolution"), 1);
    fill_field(volume, volume.n, [&](glm::dvec3 x) { return field(x).n; });
    smooth_index(volume, float(arguments.number("smoothing")));
    return volume;
}

}  // namespace

Volume make_luneburg(const ShapeArguments& arguments) {
    const double radius = arguments.number("radius");
    return sampled(LuneburgField<double>{radius}, glm::dvec3(1.0625 * radius), arguments);
}

Volume make_maxwell_fisheye(const ShapeArguments& arguments) {
    const double radius = arguments.number("radius"), n0 = arguments.number("n0");
    const MaxwellFisheyeField<double> field{radius, n0};
    const auto ball = [&](glm::dvec3 x) {
        IndexSample<double> at = field(x);
        at.n = std::max(at.n, 0.5 * n0);  // outside the ball, the index at its surface
        return at;
    };
    return sampled(ball, glm::dvec3(1.0625 * radius), arguments);
}

Volume make_linear(const ShapeArguments& arguments) {
    const double half = 0.5 * arguments.number("size"), n0 = arguments.number("n0"), slope = arguments.number("slope");
    if (n0 - std::abs(slope) * half < 0.1) arguments.fail("the index falls below 0.1 at a face");
    return sampled(LinearField<double>{n0, slope}, glm::dvec3(half), arguments);
}

Volume make_smoothed_sphere(const ShapeArguments& arguments) {
    const double radius = arguments.number("radius"), half = 1.0625 * radius;
    Volume volume = empty_grid(glm::dvec3(-half), glm::dvec3(half), arguments.whole("resolution"), 15);
    fill_solid(volume, arguments, [radius](glm::dvec3 x) { return glm::length(x) - radius; });
    return volume;
}

Volume make_rounded_cube(const ShapeArguments& arguments) {
    const double half = 0.5 * arguments.number("size"), rounding = arguments.number("rounding") * half;
    const double around = half * 1.0625;
    Volume volume = empty_grid(glm::dvec3(-around), glm::dvec3(around), arguments.whole("resolution"), 15);
    const auto distance = [=](glm::dvec3 x) {
        const glm::dvec3 q = glm::abs(x) - (half - rounding);
        return glm::length(glm::max(q, 0.0)) + std::min(std::max({q.x, q.y, q.z}), 0.0) - rounding;
    };
    fill_solid(volume, arguments, distance);
    const int layers = arguments.whole("layers");
    if (layers == 1) return volume;
    // Every second layer inside has its own index and no absorption. All layers have the same thickness.
    const double thickness = half / layers, sigma = arguments.number("smoothing") * double(volume.voxel);
    const double other = arguments.number("other-ior"), ior = arguments.number("ior");
    std::vector<float> share;
    fill_field(volume, share, [&](glm::dvec3 x) {
        double inside = 0.0;
        for (int k = 1; k < layers; ++k)
            inside += (k % 2 == 1 ? 1.0 : -1.0) * smoothed_inside(distance(x) + k * thickness, sigma);
        return inside;
    });
    for (std::size_t i = 0; i < share.size(); ++i) {
        const auto change = float((other - ior) * double(share[i]));
        volume.n[i] += change;
        if (!volume.n_red.empty()) volume.n_red[i] += change, volume.n_blue[i] += change;
        if (!volume.sigma_a.empty()) volume.sigma_a[i] *= 1.0f - share[i];
    }
    return volume;
}

// Air over hot ground bends light upwards: its index rises with height to that of the air above. The effect is real
// refraction near the horizon, exaggerated to be visible over metres.
Volume make_mirage(const ShapeArguments& arguments) {
    const double length = arguments.number("length"), height = arguments.number("height");
    const double contrast = arguments.number("contrast"), scale = arguments.number("scale");
    const glm::dvec3 low(-0.5 * length, 0.0, -0.5 * length), high(0.5 * length, height, 0.5 * length);
    Volume volume = empty_grid(low, high, arguments.whole("resolution"), 1);
    fill_field(volume, volume.n, [&](glm::dvec3 x) { return 1.0 - contrast * std::exp(-x.y / scale); });
    smooth_index(volume, float(arguments.number("smoothing")));
    return volume;
}

Volume make_smoke(const ShapeArguments& arguments) {
    const double half = 0.5 * arguments.number("size"), scale = arguments.number("noise-scale");
    Volume volume = empty_grid(glm::dvec3(-half), glm::dvec3(half), arguments.whole("resolution"), 4);
    const auto scattering = float(arguments.number("scattering"));
    std::vector<float> density;
    fill_field(volume, density, [&](glm::dvec3 x) {
        const double toward_faces = std::clamp(4.0 * (1.0 - glm::length(x) / half), 0.0, 1.0);
        return toward_faces * std::max(2.0 * fractal_noise(x, scale) - 0.6, 0.0);
    });
    volume.sigma_s.resize(density.size());
    std::transform(density.begin(), density.end(), volume.sigma_s.begin(),
                   [&](float d) { return glm::vec3(d * scattering); });
    volume.g.assign(density.size(), float(arguments.number("g")));
    return volume;
}

}  // namespace pellucid
