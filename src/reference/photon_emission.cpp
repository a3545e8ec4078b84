#include "reference/photon_emission.h"

#include "reference/microfacet.h"
#include "reference/punctual_lights.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pellucid::reference {
namespace {

using std::numbers::pi;

constexpr std::uint32_t kBlock = 4096;  ///< photons that one thread takes on

/// First radius of look-ups over that of a disc that holds one photon where nothing bends the light. A look-up then finds
/// 16 of them, and many more in a focus.
constexpr double kWidening = 4.0;

double brightest(const glm::dvec3& rgb) { return std::max({rgb.r, rgb.g, rgb.b}); }

/// The least that a material's factor and texture allow.
double lowest_roughness(const Scene& scene, const Material& material) {
    double lowest = double(material.roughness);
    const int index = material.metallic_roughness_texture.image;
    if (index < 0 || lowest == 0.0) return lowest;
    const Image& image = scene.images[std::size_t(index)];
    double texel = 1.0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) texel = std::min(texel, double(image.at(x, y)[1]));
    }
    return lowest * texel;
}

/// True if light that meets it can go on as from a mirror, or refracted without scattering.
bool has_smooth_part(const Scene& scene, const Material& material, SurfaceKind kind) {
    if (material.unlit && kind == SurfaceKind::kOpaque) return false;
    if (kind == SurfaceKind::kRefractive && material.ior == 1.0f) return true;
    if (kind == SurfaceKind::kOpaque && material.metallic == 0.0f && material.ior == 1.0f) return false;
    const double roughness = lowest_roughness(scene, material);
    return Microfacets{roughness * roughness}.smooth();
}

}  // namespace

PhotonEmitter::PhotonEmitter(const Geometry& geometry, const CurvedVolumes& volumes, const Scene& scene)
    : target_(smooth_bounds(geometry, volumes, scene)) {
    if (!(target_.radius > 0.0)) return;
    double power = 0.0;
    for (const Light& light : scene.lights) {
        Aim aim = aim_of(geometry, scene, light);
        const double own = brightest(glm::dvec3(light.intensity)) * measure(aim);
        if (!(own > 0.0)) continue;
        aim.power_up_to = power += own;
        aims_.push_back(aim);
    }
}

PhotonEmitter::Sphere PhotonEmitter::smooth_bounds(const Geometry& geometry, const CurvedVolumes& volumes,
                                                   const Scene& scene) {
    if (!volumes.empty()) {
        const Bounds all = scene_bounds(scene);
        return {glm::dvec3(all.center), double(all.radius)};
    }
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (std::uint32_t object = 0; object < geometry.object_count(); ++object) {
        if (!has_smooth_part(scene, geometry.material(object), geometry.kind(object))) continue;
        const Geometry::Box box = geometry.box(object);
        low = glm::min(low, box.low);
        high = glm::max(high, box.high);
    }
    if (!(low.x <= high.x)) return {};
    return {0.5 * (low + high), 0.5 * glm::length(high - low)};
}

PhotonEmitter::Aim PhotonEmitter::aim_of(const Geometry& geometry, const Scene& scene, const Light& light) const {
    if (light.kind == Light::Kind::kDirectional) {
        // Start before everything that may stand in the light's way.
        const Bounds all = scene_bounds(scene);
        const double before =
            glm::length(target_.center - glm::dvec3(all.center)) + 2.0 * (all.radius + target_.radius);
        const glm::dvec3 along = glm::normalize(glm::dvec3(light.direction));
        return {&light, MediumStack(geometry.solids()), target_.center - before * along, world_from_local(along)};
    }
    const glm::dvec3 position(light.position), to_target = target_.center - position;
    const double distance = glm::length(to_target), sine = target_.radius / distance;
    Aim aim{&light, geometry.solids_around(position), position, glm::dmat3(1.0)};
    if (sine < 1.0) {
        aim.world_from_aim = world_from_local(to_target / distance);
        aim.cos_limit = std::sqrt(1.0 - sine * sine);
    }
    const double cos_outer = std::cos(double(light.outer_cone_angle));
    if (light.kind == Light::Kind::kSpot && cos_outer > aim.cos_limit) {
        aim.world_from_aim = world_from_local(glm::normalize(glm::dvec3(light.direction)));
        aim.cos_limit = cos_outer;
    }
    return aim;
}

/// Area of the disc, m2, or solid angle of the cone.
double PhotonEmitter::measure(const Aim& aim) const {
    if (aim.light->kind == Light::Kind::kDirectional) return pi * target_.radius * target_.radius;
    return 2.0 * pi * (1.0 - aim.cos_limit);
}

double PhotonEmitter::first_radius(std::uint32_t count) const {
    return kWidening * target_.radius / std::sqrt(double(count));
}

PhotonStart PhotonEmitter::start(const Aim& aim, Random& random) const {
    const glm::dvec2 u = random.next2();
    const double angle = 2.0 * pi * u.y;
    PhotonStart photon{{}, aim.light, glm::dvec3(aim.light->intensity)};
    if (aim.light->kind == Light::Kind::kDirectional) {
        const double radius = target_.radius * std::sqrt(u.x);
        const glm::dvec3 on_disc(radius * std::cos(angle), radius * std::sin(angle), 0.0);
        photon.ray.origin = aim.origin + aim.world_from_aim * on_disc;
        photon.ray.direction = aim.world_from_aim[2];
        return photon;
    }
    const double z = 1.0 - u.x * (1.0 - aim.cos_limit), across = std::sqrt(std::max(1.0 - z * z, 0.0));
    photon.ray.origin = aim.origin;
    photon.ray.direction =
        glm::normalize(aim.world_from_aim * glm::dvec3(across * std::cos(angle), across * std::sin(angle), z));
    if (aim.light->kind == Light::Kind::kSpot) {
        const glm::dvec3 axis = glm::normalize(glm::dvec3(aim.light->direction));
        photon.flux *= cone_share(*aim.light, glm::dot(photon.ray.direction, axis));
    }
    return photon;
}

void PhotonEmitter::shoot(PathWalk& walk, std::uint32_t count, Random& random, std::vector<Photon>& stored) const {
    const double at = random.next() * emitted();
    const auto aim = std::find_if(aims_.begin(), aims_.end() - 1, [&](const Aim& a) { return at < a.power_up_to; });
    PhotonStart photon = start(*aim, random);
    photon.flux *= emitted() / (brightest(glm::dvec3(aim->light->intensity)) * double(count));
    walk.follow(photon, aim->inside, random, stored);
}

PhotonMap shoot_photons(const PathWorld& world, const PhotonEmitter& emitter, std::uint32_t count, std::uint32_t seed,
                        std::uint32_t round, double radius) {
    constexpr std::uint64_t kPhotons = std::uint64_t(1) << 63;  // random numbers apart from those of pixels
    std::vector<std::vector<Photon>> blocks((std::size_t(count) + kBlock - 1) / kBlock);
    tbb::parallel_for(std::size_t(0), blocks.size(), [&](std::size_t block) {
        PathWalk walk(world);
        const std::uint64_t end = std::min<std::uint64_t>((block + 1) * kBlock, count);
        for (std::uint64_t i = block * kBlock; i < end; ++i) {
            Random random(seed, kPhotons + i, round);
            emitter.shoot(walk, count, random, blocks[block]);
        }
    });
    std::vector<Photon> all;
    for (const std::vector<Photon>& block : blocks) all.insert(all.end(), block.begin(), block.end());
    return {std::move(all), radius};
}

}  // namespace pellucid::reference
