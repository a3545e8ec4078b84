#include "reference/path_walk.h"

#include "reference/boundaries.h"
#include "reference/local_frame.h"
#include "reference/surface_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace pellucid::reference {
bool has_panes(const Geometry& geometry) {
    for (std::uint32_t object = 0; object < geometry.object_count(); ++object) {
        if (geometry.kind(object) == SurfaceKind::kThin) return true;
    }
    return false;
}

PathWalk::Result PathWalk::walk(const CameraRay& ray, const MediumStack& inside, Random& random) {
    start(ray, inside);
    for (std::uint32_t vertices = 0;; ++vertices) {
        bool caught = false;
        const Hit hit = next_surface(random, caught);
        if (caught) return {radiance_, parts_, true};
        if (ball_) {
            see_ball(hit.t);
            return {radiance_, parts_, false};
        }
        if (!hit.found) {
            see_sky();
            return {radiance_, parts_, false};
        }
        if (vertices == world_.max_vertices) return {radiance_, parts_, true};
        travel(hit);
        if (!meet(hit, random)) return {radiance_, parts_, false};
        if (vertices >= kRouletteFrom && !survives(random)) return {radiance_, parts_, false};
    }
}

void PathWalk::start(const CameraRay& ray, const MediumStack& inside) {
    ray_ = {};
    ray_.origin = ray.origin;
    ray_.direction = ray.direction;
    ray_.t_max = ray.t_max;
    standing_.clear();
    inside_ = inside;
    open_ior_ = open_share_ = 1.0;
    throughput_ = glm::dvec3(1.0);
    radiance_ = glm::dvec3(0.0);
    parts_.fill(glm::dvec3(0.0));
    channel_.reset();
    pdf_ = 0.0;
    scatters_ = 0;
    bent_ = false;
    length_ = 0.0;
}

/// `caught`: a volume has kept the path.
Hit PathWalk::next_surface(Random& random, bool& caught) {
    const std::int32_t solid = inside_.solid();
    in_held_volume_ = false;
    if (!world_.volumes.bends_in(solid)) return lights_.intersect(world_.geometry, ray_, ball_);
    if (!channel_ && world_.volumes.disperses() &&
        (solid != kAir || world_.volumes.meets(ray_.origin, ray_.direction, std::numeric_limits<double>::infinity())))
        choose_channel(random);
    const CurvedVolumes::Flight flight =
        world_.volumes.fly(solid, world_.geometry, ray_, channel_.value_or(kGreen), &random, &lights_);
    ball_ = flight.ball;
    receive(part(), throughput_ * flight.emission);
    throughput_ *= flight.transmittance;
    if (solid == kAir) {
        open_ior_ = flight.ior;
        open_share_ = flight.basic;
    }
    in_held_volume_ = solid != kAir && flight.ends_inside;
    caught = flight.stuck;
    if (flight.met) {
        standing_.clear();
        ray_.standing = standing_;
        bend();
    }
    return flight.hit;
}

/// A mirror, a refraction or a volume: no source can choose the path from here on.
void PathWalk::bend() {
    pdf_ = 0.0;
    bent_ = true;
}

/// A straight piece of the path.
void PathWalk::cover(double distance) {
    if (inside_.solid() != kAir && !in_held_volume_) throughput_ *= beer_lambert(inside_.medium().sigma_a, distance);
    length_ += distance;
}

/// Goes straight on to what was met.
void PathWalk::travel(const Hit& hit) {
    cover(hit.t);
    ray_.origin = hit.position;
    ray_.t_max = std::numeric_limits<double>::infinity();  // the camera's planes cut off what it sees first
    world_.geometry.step_onto(hit, standing_);
    ray_.standing = standing_;
}

void PathWalk::turn_to(const glm::dvec3& direction) {
    ray_.direction = direction;
    for (Crossing& on : standing_) on.sense = world_.geometry.sense(on.object, on.triangle, direction);
    ray_.standing = standing_;
}

PathWalk::Vertex PathWalk::vertex_at(const Hit& hit, const glm::dvec3& direction) const {
    const Geometry& geometry = world_.geometry;
    const auto [object, triangle, sense, shell] = hit.crossing;
    const Mesh& mesh = world_.scene.meshes[std::size_t(world_.scene.objects[object].mesh)];
    Vertex vertex{hit,
                  geometry.material(object),
                  interpolate_attributes(mesh, triangle, glm::vec2(float(hit.u), float(hit.v))),
                  glm::dvec4(1.0),
                  glm::dvec3(0.0),
                  glm::dvec3(0.0)};
    vertex.base = base_color(world_.scene, vertex.material, vertex.attributes);
    const double side = sense == Sense::kEntering ? 1.0 : -1.0;
    vertex.normal = side * geometry.shading_normal(hit);
    // An interpolated normal can face away from where the path comes from: nothing is seen of such a side.
    if (!(glm::dot(vertex.normal, direction) < 0.0)) vertex.normal = side * geometry.geometric_normal(hit);
    vertex.smooth = vertex.normal;
    const Texture& texture = vertex.material.normal_texture;
    if (texture.image < 0) return vertex;
    const glm::dvec3 outward = side * vertex.smooth;
    const glm::dvec3 tilted = tilted_normal(world_.scene, geometry, hit, outward, texture,
                                            double(vertex.material.normal_scale), vertex.attributes);
    if (tilted != outward)
        vertex.normal = mirroring_above(side * tilted, side * geometry.geometric_normal(hit), -direction);
    return vertex;
}

bool PathWalk::crosses(const Hit& hit, const glm::dvec3& direction) const {
    return world_.geometry.sense(hit.crossing.object, hit.crossing.triangle, direction) == hit.crossing.sense;
}

/// What happens at a surface. Returns false where the path ends.
bool PathWalk::meet(const Hit& hit, Random& random) {
    const SurfaceKind kind = world_.geometry.kind(hit.crossing.object);
    if (kind == SurfaceKind::kRefractive) return meet_solid(hit, random);
    if (inside_.solid() != kAir) {
        const Hit wall = touching_boundary(world_.geometry, ray_, hit);
        if (wall.found && wall.crossing.sense == Sense::kLeaving) {  // what a solid stands on is outside of it
            standing_.back() = wall.crossing;
            ray_.standing = standing_;
            return meet_solid(wall, random);
        }
    }
    const Vertex vertex = vertex_at(hit, ray_.direction);
    return kind == SurfaceKind::kThin ? meet_pane(vertex, random) : meet_opaque(vertex, random);
}

bool PathWalk::meet_opaque(const Vertex& vertex, Random& random) {
    if (vertex.material.unlit) {
        receive(part(), throughput_ * glm::dvec3(vertex.base));
        return false;
    }
    emit(vertex);
    const Bsdf bsdf = opaque_bsdf(vertex);
    if (photon_.stored && !std::visit([](const auto& b) { return b.only_mirrors(); }, bsdf)) deposit(vertex);
    return scatter(vertex, bsdf, random);
}

/// At the surface on which the path stands.
double PathWalk::ior(const MediumStack& at, int channel) const {
    if (at.solid() == kAir) return open_ior_;
    return world_.volumes.index_at(at.solid(), ray_.origin, channel).value_or(at.medium().ior[channel]);
}

/// Share of light emitted into the medium `at` that a path carries: 1 / n^2, since paths carry radiance over n^2.
/// `open_share`: the share around all solids.
double PathWalk::emitted_share(const MediumStack& at, double open_share) const {
    if (at.solid() == kAir) return open_share;
    const double n = ior(at, channel_.value_or(kGreen));
    return 1.0 / (n * n);
}

/// True if `direction` leads to the other side of a boundary of glass, into the medium beyond_.
bool PathWalk::refracts_towards(const Hit& from, const glm::dvec3& direction) const {
    return crosses(from, direction) && world_.geometry.kind(from.crossing.object) == SurfaceKind::kRefractive;
}

Bsdf PathWalk::opaque_bsdf(const Vertex& vertex) const {
    const auto [metallic, roughness] = metallic_roughness(world_.scene, vertex.material, vertex.attributes);
    // What a translucent surface sends to the other side it does not reflect. (That light is not followed.)
    const double reflected = vertex.material.translucent() ? 1.0 - double(vertex.material.diffuse_transmission) : 1.0;
    const glm::dvec3 base = reflected * glm::dvec3(vertex.base);
    if (!vertex.material.finish.plain()) return finished_bsdf(vertex, base);
    return OpaqueBsdf(base, double(metallic), double(roughness), double(vertex.material.ior));
}

FinishedBsdf PathWalk::finished_bsdf(const Vertex& vertex, const glm::dvec3& base) const {
    const Finish& f = vertex.material.finish;
    const FinishTexels texels = finish_texels(world_.scene, f, vertex.attributes);
    const auto [metallic, roughness] = metallic_roughness(world_.scene, vertex.material, vertex.attributes);
    FinishedPoint point{.base = base,
                        .metallic = double(metallic),
                        .roughness = double(roughness),
                        .ior = double(vertex.material.ior),
                        .coat = texels.clearcoat,
                        .coat_roughness = texels.clearcoat_roughness,
                        .sheen = texels.sheen_color,
                        .sheen_roughness = texels.sheen_roughness,
                        .specular = texels.specular,
                        .specular_color = texels.specular_color,
                        .film = texels.iridescence,
                        .film_ior = double(f.film_ior),
                        .film_thickness_nm = texels.film_thickness_nm,
                        .anisotropy = texels.anisotropy};
    const glm::dmat3 to_local = glm::transpose(world_from_local(vertex.normal));
    const double side = vertex.hit.crossing.sense == Sense::kEntering ? 1.0 : -1.0;
    if (f.coated()) {
        const glm::dvec3 outward = side * vertex.smooth;
        const glm::dvec3 tilted =
            tilted_normal(world_.scene, world_.geometry, vertex.hit, outward, f.clearcoat_normal_texture,
                          double(f.clearcoat_normal_scale), vertex.attributes);
        const glm::dvec3 normal =
            tilted != outward
                ? mirroring_above(side * tilted, side * world_.geometry.geometric_normal(vertex.hit), -ray_.direction)
                : vertex.smooth;
        point.coat_normal = normal == vertex.normal ? glm::dvec3(0.0, 0.0, 1.0) : to_local * normal;
    }
    if (point.anisotropy > 0.0) {
        const int set = f.anisotropy_texture.image >= 0 ? f.anisotropy_texture.texcoord_set : 0;
        const std::optional<glm::dmat3> frame = tangent_frame(world_.geometry, vertex.hit, side * vertex.normal, set);
        const glm::dvec3 along =
            frame ? to_local * (*frame * glm::dvec3(texels.anisotropy_direction, 0.0)) : glm::dvec3(0.0);
        const double length = glm::length(glm::dvec2(along));
        if (length > 0.0)
            point.along = glm::dvec2(along) / length;
        else
            point.anisotropy = 0.0;  // nothing says the direction
    }
    return FinishedBsdf(point);
}

double PathWalk::roughness_at(const Vertex& vertex) const {
    return double(metallic_roughness(world_.scene, vertex.material, vertex.attributes).roughness);
}

/// Glass with probability `transmission`, else the opaque surface that is mixed into it.
bool PathWalk::transmits(const Vertex& vertex, Random& random) const {
    const double share = double(transmission(world_.scene, vertex.material, vertex.attributes));
    return share >= 1.0 || random.next() < share;
}

bool PathWalk::meet_solid(const Hit& hit, Random& random) {
    const Hit interface = cross_boundaries(world_.geometry, ray_, hit, standing_, inside_, beyond_);
    if (!is_interface(inside_, beyond_)) {  // such as a boundary inside a solid that displaces it
        std::swap(inside_, beyond_);
        turn_to(ray_.direction);
        bend();
        return true;
    }
    const Vertex vertex = vertex_at(interface, ray_.direction);
    const bool entering = interface.crossing.sense == Sense::kEntering;
    if (entering) emit(vertex);
    const bool photon = photon_.stored != nullptr;
    if (!photon && entering && !transmits(vertex, random)) return scatter(vertex, opaque_bsdf(vertex), random);
    // A solid's base colour tints light once on its way through, where the path comes in, as does the
    // renderer. The same goes for the opaque part: it is a coat of the outside. Light goes the other way.
    const glm::dvec3 tint = entering != photon ? glm::dvec3(vertex.base) : glm::dvec3(1.0);
    const Medium here = inside_.medium(), there = beyond_.medium();
    if (!channel_ && (here.disperses() || there.disperses())) choose_channel(random);
    const int channel = channel_.value_or(kGreen);  // without dispersion all are alike
    const InterfaceBsdf bsdf(ior(inside_, channel), ior(beyond_, channel), roughness_at(vertex), tint);
    return photon ? cross_as_photon(vertex, bsdf, random) : scatter(vertex, bsdf, random);
}

bool PathWalk::meet_pane(const Vertex& vertex, Random& random) {
    const PaneBsdf bsdf(double(vertex.material.ior), roughness_at(vertex), glm::dvec3(vertex.base));
    if (photon_.stored &&
        (!bsdf.only_mirrors() || transmission(world_.scene, vertex.material, vertex.attributes) < 1.0f))
        deposit(vertex);
    if (vertex.material.alpha_is_coverage && random.next() >= vertex.base.a) {  // past it
        turn_to(ray_.direction);
        return true;
    }
    emit(vertex);
    if (!transmits(vertex, random)) return scatter(vertex, opaque_bsdf(vertex), random);
    return scatter(vertex, bsdf, random);
}

bool PathWalk::scatter(const Vertex& vertex, const Bsdf& bsdf, Random& random) {
    const glm::dmat3 to_world = world_from_local(vertex.normal);
    const Facing facing{to_world, -ray_.direction * to_world};
    if (!photon_.stored && !std::visit([](const auto& b) { return b.only_mirrors(); }, bsdf)) {
        add_environment(vertex, bsdf, facing, random);
        for (const Light& light : world_.scene.lights) add_light(light, vertex, bsdf, facing, random);
        if (world_.emitters) add_emission(vertex, bsdf, facing, random);
        if (world_.photons) add_photons(vertex, bsdf, facing, random);
    }

    const std::optional<BsdfSample> sample =
        std::visit([&](const auto& b) { return b.sample(facing.wo, random); }, bsdf);
    if (!sample || (photon_.stored && !sample->mirror)) return false;
    const glm::dvec3 direction = glm::normalize(to_world * sample->wi);
    // Interpolated normals can send light to the other side of the surface itself than they mean to. Out of
    // an opaque one nothing comes; at glass, the path then is where it is.
    const bool through = crosses(vertex.hit, direction);
    const bool means_to = sample->wi.z < 0.0;
    const bool opaque = std::holds_alternative<OpaqueBsdf>(bsdf) || std::holds_alternative<FinishedBsdf>(bsdf);
    if (opaque && through) return false;
    if (through && std::holds_alternative<InterfaceBsdf>(bsdf)) std::swap(inside_, beyond_);

    throughput_ *= sample->weight;
    if (photon_.stored) throughput_ *= adjoint_weight(vertex, -ray_.direction, direction);
    const bool straight = sample->mirror && means_to && std::holds_alternative<PaneBsdf>(bsdf);
    if (sample->mirror && !straight) bend();
    if (!sample->mirror) scatter_from(vertex.hit.position, through == means_to ? sample->pdf : 0.0);
    turn_to(direction);
    return true;
}

/// A surface that is not smooth has chosen a direction with density `pdf`; 0: sources cannot choose it.
void PathWalk::scatter_from(const glm::dvec3& position, double pdf) {
    pdf_ = pdf;
    scattered_at_ = position;
    ++scatters_;
    bent_ = false;
    length_ = 0.0;
}

/// Russian roulette on what the path still can carry; lossless paths always go on.
bool PathWalk::survives(Random& random) {
    const double most = std::max({throughput_.r, throughput_.g, throughput_.b});
    if (most >= 1.0) return true;
    if (!(random.next() < most)) return false;
    throughput_ /= most;
    return true;
}

/// Leaves the path one channel, with a probability in proportion to what it carries; divided by that, it then
/// carries there what all three did.
void PathWalk::choose_channel(Random& random) {
    const double sum = throughput_.r + throughput_.g + throughput_.b;
    const double at = random.next() * sum;
    channel_ = at < throughput_.r ? kRed : at < throughput_.r + throughput_.g ? kGreen : kBlue;
    throughput_ = glm::dvec3(0.0);
    throughput_[*channel_] = sum;
}

}  // namespace pellucid::reference
