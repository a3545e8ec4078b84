#include "reference/photon_emission.h"

#include "reference/local_frame.h"
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

constexpr std::uint32_t kBlock = 4096;  ///< photons per task of a thread

/// First look-up radius over the radius of a disc that contains one photon without any bending. A look-up then finds
/// 16 photons, and many more at a focus.
constexpr double kWidening = 4.0;

double brightest(const glm::dvec3& rgb) { return std::max({rgb.r, rgb.g, rgb.b}); }

/// Lower bound of the roughness, from the material's factor and texture.
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

/// True if light can be mirrored by it, or refracted without scattering.
bool has_smooth_part(const Scene& scene, const Material& material, SurfaceKind kind) {
    if (material.unlit && kind == SurfaceKind::kOpaque) return false;
    if (kind == SurfaceKind::kRefractive && material.ior == 1.0f) return true;
    if (kind == SurfaceKind::kOpaque && material.metallic == 0.0f && material.ior == 1.0f) return false;
    const double roughness = lowest_roughness(scene, material);
    return Microfacets{roughness * roughness}.smooth();
}

bool boxes_meet(const Geometry::Box& a, const Geometry::Box& b, double apart) {
    return glm::all(glm::lessThanEqual(a.low - apart, b.high)) && glm::all(glm::lessThanEqual(b.low - apart, a.high));
}

/// True if part of an object's boundary may be no interface, inside a solid or between equal media. Light crosses such
/// a boundary unscattered, however rough it is. The test uses bounding boxes.
bool may_part_nothing(const Geometry& geometry, std::uint32_t object) {
    if (geometry.kind(object) != SurfaceKind::kRefractive) return false;
    const auto body_of = [&](std::uint32_t of) { return geometry.solid_of(geometry.shell(of, 0)) / 2; };
    const auto triangles = std::uint32_t(geometry.mesh(object).triangles.size());
    for (std::uint32_t t = 1; t < triangles; ++t) {
        if (geometry.shell(object, t) != geometry.shell(object, 0)) return true;
    }
    for (std::uint32_t other = 0; other < geometry.object_count(); ++other) {
        if (geometry.kind(other) == SurfaceKind::kRefractive && body_of(other) != body_of(object) &&
            boxes_meet(geometry.box(object), geometry.box(other), geometry.widest_contact()))
            return true;
    }
    return false;
}

}  // namespace

PhotonEmitter::PhotonEmitter(const Geometry& geometry, const CurvedVolumes& volumes, const Scene& scene)
    : geometry_(geometry), target_(scene.lights.empty() ? Sphere{} : smooth_bounds(geometry, volumes, scene)) {
    if (!(target_.radius > 0.0)) return;
    double power = 0.0;
    for (const Light& light : scene.lights) {
        Aim aim = light.kind == Light::Kind::kDirectional ? aim_of_sun(scene, light) : aim_of_lamp(light);
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
        if (!has_smooth_part(scene, geometry.material(object), geometry.kind(object)) &&
            !may_part_nothing(geometry, object))
            continue;
        const Geometry::Box box = geometry.box(object);
        low = glm::min(low, box.low);
        high = glm::max(high, box.high);
    }
    if (!(low.x <= high.x)) return {};
    return {0.5 * (low + high), 0.5 * glm::length(high - low)};
}

PhotonEmitter::Aim PhotonEmitter::aim_of_sun(const Scene& scene, const Light& light) const {
    Aim aim{
        .light = &light, .inside = MediumStack(geometry_.solids()), .center = target_.center, .disc = target_.radius};
    // Photons start in front of all possible occluders.
    const Bounds all = scene_bounds(scene);
    aim.before = glm::length(target_.center - glm::dvec3(all.center)) + 2.0 * (all.radius + target_.radius);
    aim.world_from_cone = world_from_local(glm::normalize(glm::dvec3(light.direction)));
    aim.one_less_cosine = one_less_cosine(light);
    return aim;
}

PhotonEmitter::Aim PhotonEmitter::aim_of_lamp(const Light& light) const {
    const glm::dvec3 center(light.position), to_target = target_.center - center;
    Aim aim{.light = &light, .inside = std::nullopt, .center = center, .disc = double(light.radius)};
    if (aim.disc == 0.0 || geometry_.in_air(center - aim.disc, center + aim.disc))
        aim.inside = geometry_.solids_around(center);
    const double distance = glm::length(to_target), sine = (target_.radius + aim.disc) / distance;
    if (sine < 1.0) {
        aim.world_from_cone = world_from_local(to_target / distance);
        aim.one_less_cosine = sine * sine / (1.0 + std::sqrt(1.0 - sine * sine));
    }
    const double outer = 1.0 - std::cos(double(light.outer_cone_angle));
    if (light.kind == Light::Kind::kSpot && outer < aim.one_less_cosine) {
        aim.world_from_cone = world_from_local(glm::normalize(glm::dvec3(light.direction)));
        aim.one_less_cosine = outer;
    }
    return aim;
}

/// Factor from a light's brightest channel to the flux of its photons: area of the disc, m2, or solid angle of the
/// cone.
double PhotonEmitter::measure(const Aim& aim) const {
    if (aim.light->kind == Light::Kind::kDirectional) return pi * aim.disc * aim.disc;
    return 2.0 * pi * aim.one_less_cosine;
}

double PhotonEmitter::first_radius(std::uint32_t count) const {
    return kWidening * target_.radius / std::sqrt(double(count));
}

PhotonStart PhotonEmitter::start(const Aim& aim, Random& random) const {
    PhotonStart photon{{}, aim.light, glm::dvec3(aim.light->intensity)};
    glm::dvec3& direction = photon.ray.direction;
    direction = glm::normalize(aim.world_from_cone * uniform_in_cone(aim.one_less_cosine, random.next2()));
    const glm::dvec2 u = random.next2();
    const double from_axis = aim.disc * std::sqrt(u.x), angle = 2.0 * pi * u.y;
    const glm::dvec3 on_disc =
        world_from_local(direction) * glm::dvec3(from_axis * std::cos(angle), from_axis * std::sin(angle), 0.0);
    const bool sun = aim.light->kind == Light::Kind::kDirectional;
    // A ball has uniform radiance, so its points are uniform on the disc that it appears as.
    const double ahead = sun ? -aim.before : aim.disc * std::sqrt(std::max(1.0 - u.x, 0.0));
    photon.ray.origin = aim.center + on_disc + ahead * direction;
    if (aim.light->kind == Light::Kind::kSpot) {
        const glm::dvec3 axis = glm::normalize(glm::dvec3(aim.light->direction));
        photon.flux *= cone_share(*aim.light, glm::dot(direction, axis));
    }
    return photon;
}

void PhotonEmitter::shoot(PathWalk& walk, std::uint32_t count, Random& random, std::vector<Photon>& stored) const {
    const double at = random.next() * emitted();
    const auto aim = std::find_if(aims_.begin(), aims_.end() - 1, [&](const Aim& a) { return at < a.power_up_to; });
    PhotonStart photon = start(*aim, random);
    photon.flux *= emitted() / (brightest(glm::dvec3(aim->light->intensity)) * double(count));
    walk.follow(photon, aim->inside ? *aim->inside : geometry_.solids_around(photon.ray.origin), random, stored);
}

std::vector<std::string> PhotonEmitter::without_size() const {
    std::vector<std::string> names;
    for (const Aim& aim : aims_) {
        if (!has_size(*aim.light)) names.push_back(aim.light->name);
    }
    return names;
}

std::vector<Photon> shoot_photons(const PathWorld& world, const PhotonEmitter& emitter, std::uint32_t count,
                                  std::uint32_t seed, std::uint32_t round) {
    constexpr std::uint64_t kPhotons = std::uint64_t(1) << 63;  // keeps random numbers distinct from those of pixels
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
    return all;
}

}  // namespace pellucid::reference
