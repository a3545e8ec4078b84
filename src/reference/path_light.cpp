// The part of PathWalk that gathers light: by hitting emitters, and by next-event estimation.
#include "reference/boundaries.h"
#include "reference/path_walk.h"

#include <cmath>
#include <limits>
#include <optional>

namespace pellucid::reference {
namespace {

/// MIS weight of a direction sampled with density `pdf`, which the other strategy samples with density `other` (Veach
/// 1997, section 9.2.4, exponent 2).
double power_heuristic(double pdf, double other) {
    const double ratio = other / pdf;
    return 1.0 / (1.0 + ratio * ratio);
}

}  // namespace

/// Part of the image to which light at the current vertex belongs.
LightPart PathWalk::part() const {
    if (scatters_ == 0) return LightPart::kEmitted;
    if (scatters_ > 1) return LightPart::kIndirect;
    return bent_ ? LightPart::kCaustic : LightPart::kDirect;
}

/// MIS weight of a sized light that the path hits.
double PathWalk::weight_of_chance(const Light& light) const {
    if (pdf_ > 0.0) return power_heuristic(pdf_, arriving_pdf(light, scattered_at_));
    const bool photons_have_it = world_.photons && scatters_ > 0 && bent_;
    return photons_have_it ? 0.0 : 1.0;
}

/// MIS weight of an emissive surface that the path hits.
double PathWalk::weight_of_chance(const Hit& emitter) const {
    if (!(pdf_ > 0.0) || !world_.emitters) return 1.0;
    return power_heuristic(pdf_, world_.emitters->pdf(scattered_at_, emitter));
}

void PathWalk::emit(const Vertex& vertex) {
    const glm::dvec3 light(emission(world_.scene, vertex.material, vertex.attributes));
    if (light == glm::dvec3(0.0)) return;
    receive(part(), throughput_ * light * (emitted_share() * weight_of_chance(vertex.hit)));
}

/// Adds environment light when the path leaves the scene. In an open mesh the path may still seem to be inside
/// infinite glass, whose absorption is ignored.
void PathWalk::see_sky() {
    const glm::dvec3 light = radiance(world_.environment, glm::vec3(ray_.direction));
    const double weight = pdf_ > 0.0 ? power_heuristic(pdf_, world_.sampler.pdf(ray_.direction)) : 1.0;
    receive(part(), throughput_ * light * weight);
    lights_.for_each_sun(ray_.direction, [&](const Light& sun) {
        receive(part(), throughput_ * radiance_of(sun, ray_.direction) * weight_of_chance(sun));
    });
}

/// Adds the light of a lamp that the path hits and ends on. Light seen without scattering does not fade with the
/// lamp's range.
void PathWalk::see_ball(double distance) {
    cover(distance);
    const double range = scatters_ > 0 ? range_share(*ball_, length_) : 1.0;
    receive(part(),
            throughput_ * emitted_share() * radiance_of(*ball_, ray_.direction) * (range * weight_of_chance(*ball_)));
}

BsdfValue PathWalk::value_towards(const Vertex& vertex, const Bsdf& bsdf, const Facing& facing,
                                  const glm::dvec3& direction, Random& random) const {
    const glm::dvec3 wi = direction * facing.world_from_local;
    if (crosses(vertex.hit, direction) != (wi.z < 0.0)) return {};
    return std::visit([&](const auto& b) { return b.evaluate(facing.wo, wi, random); }, bsdf);
}

/// Next-event estimation of the environment, in a direction sampled by it.
void PathWalk::add_environment(const Vertex& vertex, const Bsdf& bsdf, const Facing& facing, Random& random) {
    if (world_.sampler.dark()) return;
    const EnvironmentSampler::Sample chosen = world_.sampler.sample(random);
    const BsdfValue bsdf_value = value_towards(vertex, bsdf, facing, chosen.direction, random);
    if (!(bsdf_value.pdf > 0.0)) return;
    const glm::dvec3 light = radiance(world_.environment, glm::vec3(chosen.direction));
    const double weight = power_heuristic(chosen.pdf, bsdf_value.pdf) / chosen.pdf;
    receive(part_through(LightPart::kDirect),
            throughput_ * bsdf_value.value * light * weight *
                visibility(vertex.hit, chosen.direction, std::numeric_limits<double>::infinity(), nullptr));
}

/// Next-event estimation of one of the scene's lights, in a direction sampled by it.
void PathWalk::add_light(const Light& light, const Vertex& vertex, const Bsdf& bsdf, const Facing& facing,
                         Random& random) {
    const std::optional<ArrivingLight> arriving = arriving_light(light, vertex.hit.position, random);
    if (!arriving) return;
    const BsdfValue bsdf_value = value_towards(vertex, bsdf, facing, arriving->direction, random);
    if (!(bsdf_value.pdf > 0.0)) return;
    // Light from beyond the surface was emitted in the medium there. It crosses no volume: visibility() is 0 in
    // volumes.
    const double share =
        refracts_towards(vertex.hit, arriving->direction) ? emitted_share(beyond_, 1.0) : emitted_share();
    const double weight = arriving->pdf > 0.0 ? power_heuristic(arriving->pdf, bsdf_value.pdf) : 1.0;
    receive(part_through(LightPart::kDirect),
            throughput_ * (share * weight) * bsdf_value.value * arriving->irradiance *
                visibility(vertex.hit, arriving->direction, arriving->distance, &light));
}

/// Next-event estimation of an emissive surface, towards a sampled point.
void PathWalk::add_emission(const Vertex& vertex, const Bsdf& bsdf, const Facing& facing, Random& random) {
    const std::optional<EmitterSampler::Sample> chosen = world_.emitters->sample(vertex.hit.position, random);
    if (!chosen) return;
    const BsdfValue bsdf_value = value_towards(vertex, bsdf, facing, chosen->direction, random);
    if (!(bsdf_value.pdf > 0.0)) return;
    const double share =
        refracts_towards(vertex.hit, chosen->direction) ? emitted_share(beyond_, 1.0) : emitted_share();
    const double weight = share * power_heuristic(chosen->pdf, bsdf_value.pdf) / chosen->pdf;
    receive(part_through(LightPart::kDirect),
            throughput_ * bsdf_value.value * weight * visible_emission(vertex.hit, *chosen));
}

glm::dvec3 PathWalk::irradiance(const Hit& on, Random& random) {
    const auto [object, triangle, sense, shell] = on.crossing;
    if (world_.geometry.cut_out(object, triangle, on.u, on.v)) return glm::dvec3(0.0);
    start({.origin = on.position}, world_.geometry.solids_around(on.position));
    world_.geometry.step_onto(on, standing_);
    const glm::dvec3 normal = world_.geometry.geometric_normal(on);
    glm::dvec3 sum(0.0);
    for (const Light& light : world_.scene.lights) {
        const std::optional<ArrivingLight> arriving = arriving_light(light, on.position, random);
        const double cosine = arriving ? glm::dot(arriving->direction, normal) : 0.0;
        if (cosine == 0.0 || (cosine < 0.0 && world_.geometry.material(object).single_sided())) continue;
        sum +=
            arriving->irradiance * std::abs(cosine) * visibility(on, arriving->direction, arriving->distance, &light);
    }
    return sum;
}

/// Share of the light from a source at `distance` that reaches a surface. `light`: the source, if it is a light of the
/// scene.
glm::dvec3 PathWalk::visibility(const Hit& from, const glm::dvec3& direction, double distance, const Light* light) {
    const MediumStack& inside = medium_towards(from, direction);
    Query query = shadow_ray(from, direction, distance);
    query.kinds = only(SurfaceKind::kOpaque) | only(SurfaceKind::kRefractive);
    if (world_.geometry.occluded(query) || lights_.nearest(query, light).light) return glm::dvec3(0.0);
    if (meets_volume(inside, query)) return glm::dvec3(0.0);
    glm::dvec3 share(1.0);
    // A ray to infinity crosses glass of open meshes only; see see_sky().
    if (inside.solid() != kAir && std::isfinite(distance)) share = beer_lambert(inside.medium().sigma_a, distance);
    return world_.has_panes ? share * pane_transmittance(query) : share;
}

/// Radiance from the sampled point of an emissive surface, if a straight ray hits that triangle first.
glm::dvec3 PathWalk::visible_emission(const Hit& from, const EmitterSampler::Sample& chosen) {
    const MediumStack& inside = medium_towards(from, chosen.direction);
    Query query = shadow_ray(from, chosen.direction, chosen.distance);
    if (lights_.nearest(query).light || meets_volume(inside, query)) return glm::dvec3(0.0);
    glm::dvec3 share(1.0);
    if (inside.solid() != kAir) share = beer_lambert(inside.medium().sigma_a, chosen.distance);
    query.t_max = std::numeric_limits<double>::infinity();  // rounding must not end the ray before the emitter
    while (share != glm::dvec3(0.0)) {
        const Hit hit = world_.geometry.intersect(query);
        if (!hit.found) break;
        const bool arrives = hit.crossing.object == chosen.object && hit.crossing.triangle == chosen.triangle;
        const bool pane = world_.geometry.kind(hit.crossing.object) == SurfaceKind::kThin;
        if (!arrives && !pane) break;
        step_through(hit, query);
        if (inside.solid() != kAir) {  // an object that supports a solid lies outside of it; see meet()
            const Hit wall = touching_boundary(world_.geometry, query, hit);
            if (wall.found && wall.crossing.sense == Sense::kLeaving) break;
        }
        const Vertex vertex = vertex_at(hit, query.direction);
        if (arrives) {
            const double coverage = pane && vertex.material.alpha_is_coverage ? vertex.base.a : 1.0;
            return share * coverage * glm::dvec3(emission(world_.scene, vertex.material, vertex.attributes));
        }
        share *= straight_through(vertex, query.direction);
    }
    return glm::dvec3(0.0);
}

/// Shadow ray from a surface on which the path stands towards a source.
Query PathWalk::shadow_ray(const Hit& from, const glm::dvec3& direction, double distance) {
    shadow_standing_ = standing_;
    for (Crossing& on : shadow_standing_) on.sense = world_.geometry.sense(on.object, on.triangle, direction);
    Query query;
    query.origin = from.position;
    query.direction = direction;
    query.t_max = distance;
    query.standing = shadow_standing_;
    return query;
}

/// True if the shadow ray, in the solids `inside`, crosses a volume, which bends light.
bool PathWalk::meets_volume(const MediumStack& inside, const Query& query) const {
    return inside.solid() == kAir ? world_.volumes.meets(query.origin, query.direction, query.t_max)
                                  : world_.volumes.bends_in(inside.solid());
}

/// Moves a shadow ray to a pane that it hit.
void PathWalk::step_through(const Hit& pane, Query& query) {
    world_.geometry.step_onto(pane, shadow_standing_);
    query.standing = shadow_standing_;
    query.origin = pane.position;
    query.t_max -= pane.t;
}

/// Transmittance of a smooth pane for straight light. Rough panes scatter it and transmit nothing.
glm::dvec3 PathWalk::straight_through(const Vertex& pane, const glm::dvec3& direction) const {
    const PaneBsdf bsdf(double(pane.material.ior), roughness_at(pane), glm::dvec3(pane.base));
    const double coverage = pane.material.alpha_is_coverage ? pane.base.a : 1.0;
    glm::dvec3 through(0.0);
    if (bsdf.only_mirrors())
        through = bsdf.straight_through(-glm::dot(pane.normal, direction)) *
                  double(transmission(world_.scene, pane.material, pane.attributes));
    return (1.0 - coverage) + coverage * through;
}

/// Transmittance of all panes along a shadow ray.
glm::dvec3 PathWalk::pane_transmittance(Query query) {
    query.kinds = only(SurfaceKind::kThin);
    glm::dvec3 share(1.0);
    while (share != glm::dvec3(0.0)) {
        const Hit hit = world_.geometry.intersect(query);
        if (!hit.found) break;
        share *= straight_through(vertex_at(hit, query.direction), query.direction);
        step_through(hit, query);
    }
    return share;
}

}  // namespace pellucid::reference
