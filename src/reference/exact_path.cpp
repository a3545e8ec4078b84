#include "reference/exact_path.h"

#include "reference/boundaries.h"
#include "reference/dielectric.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace pellucid::reference {
namespace {

constexpr SurfaceKinds kMet = only(SurfaceKind::kOpaque) | only(SurfaceKind::kRefractive);

}  // namespace

ExactPath::ExactPath(const Geometry& geometry, std::uint32_t max_events, int channel)
    : geometry_(geometry), max_events_(max_events), channel_(channel), inside_(geometry.solids()),
      beyond_(geometry.solids()) {}

void ExactPath::start(const CameraRay& ray, const MediumStack& inside) {
    ray_.origin = ray.origin;
    ray_.direction = ray.direction;
    ray_.t_max = ray.t_max;
    ray_.kinds = kMet;
    standing_.clear();
    ray_.standing = standing_;
    inside_ = inside;
    transmittance_ = glm::dvec3(1.0);
    length_ = ray.before;
    length_inside_ = 0.0;
    open_ior_ = 1.0;
    crossed_volume_ = false;
    result_ = {};
    met_ = {};
    result_.direction = glm::vec3(ray_.direction);
    result_.position = glm::vec3(ray_.origin - ray.before * ray_.direction);
}

bool ExactPath::finish(Status status) {
    result_.status = status;
    result_.direction = glm::vec3(ray_.direction);
    result_.transmittance = glm::vec3(transmittance_);
    result_.length_inside = float(length_inside_);
    if (crossed_volume_) result_.events = std::max<std::uint16_t>(result_.events, 1);
    return false;
}

SurfacePath ExactPath::surfaces() const {
    SurfacePath surfaces = met_;
    surfaces.path = result_;
    return surfaces;
}

double ExactPath::ior(const MediumStack& at, const glm::dvec3& position) const {
    if (at.solid() == kAir) return open_ior_;
    const std::optional<double> held =
        volumes_ != nullptr ? volumes_->index_at(at.solid(), position, channel_) : std::nullopt;
    return held.value_or(at.medium().ior[channel_]);
}

bool ExactPath::fly(const CurvedVolumes& volumes) {
    volumes_ = &volumes;
    const std::int32_t solid = inside_.solid();
    if (!volumes.bends_in(solid)) return advance(geometry_.intersect(ray_));
    const CurvedVolumes::Flight flight = volumes.fly(solid, geometry_, ray_, channel_);
    if (flight.met) {
        standing_.clear();
        ray_.standing = standing_;
    }
    if (flight.met && solid == kAir) {
        crossed_volume_ = true;
        result_.position = glm::vec3(flight.left_at);
        result_.length = float(length_ + flight.left_after);
    }
    length_ += flight.length;
    length_inside_ += flight.length_inside;
    transmittance_ *= flight.transmittance;
    met_.attenuation *= glm::vec3(flight.transmittance);
    if (solid == kAir) open_ior_ = flight.ior;
    in_held_volume_ = solid != kAir && flight.ends_inside;
    return flight.stuck ? finish(Status::kStepLimit) : advance(flight.hit);
}

/// Moves the path straight to `hit`.
void ExactPath::travel(const Hit& hit) {
    length_ += hit.t;
    if (inside_.solid() != kAir && !std::exchange(in_held_volume_, false)) {
        length_inside_ += hit.t;
        const glm::dvec3 left = beer_lambert(inside_.medium().sigma_a, hit.t);
        transmittance_ *= left;
        met_.attenuation *= glm::vec3(left);
    }
    ray_.origin = hit.position;
    ray_.t_max = std::numeric_limits<double>::infinity();  // the camera's planes clip the first segment only
    geometry_.step_onto(hit, standing_);
    ray_.standing = standing_;
}

/// Refracts or totally reflects the path at an interface. The interpolated normal may send a reflected path through
/// the triangle (1 to 4 in 100 reflections in meshes of animals). The path then leaks out, and cross() puts it on the
/// far side.
void ExactPath::bend(const Hit& hit) {
    const double n_i = ior(inside_, hit.position), n_t = ior(beyond_, hit.position);
    const glm::dvec3 outward = geometry_.shading_normal(hit);
    const glm::dvec3 normal = hit.crossing.sense == Sense::kEntering ? outward : -outward;
    const Incidence in = incidence(ray_.direction, normal, n_i, n_t);
    if (in.total) {
        ray_.direction = reflected(ray_.direction, normal, in);
        ++result_.reflections;
    } else {
        ray_.direction = refracted(ray_.direction, normal, n_i, n_t, in);
        transmittance_ *= 1.0 - in.reflectance;
        met_.fresnel *= float(1.0 - in.reflectance);
    }
    met_.last = {
        .object = std::int32_t(hit.crossing.object), .position = glm::vec3(hit.position), .normal = glm::vec3(outward)};
    if (result_.events < 2) (result_.events == 0 ? met_.first : met_.second) = met_.last;
    ++result_.events;
    result_.side_conflict = result_.side_conflict || in.conflict;
    result_.position = glm::vec3(hit.position);
    result_.length = float(length_);
    for (Crossing& on : standing_) on.sense = geometry_.sense(on.object, on.triangle, ray_.direction);
}

/// Crosses the boundary of a solid, and those of other solids that touch it there.
bool ExactPath::cross(const Hit& hit) {
    const Hit interface = cross_boundaries(geometry_, ray_, hit, standing_, inside_, beyond_);
    ray_.standing = standing_;
    bool through = true;
    if (is_interface(inside_, beyond_)) {
        if (result_.events == max_events_) return finish(Status::kEventLimit);
        bend(interface);
        through = crossing_sense(ray_.direction, interface.normal) == interface.crossing.sense;
    }
    if (through) std::swap(inside_, beyond_);
    return true;
}

bool ExactPath::advance(const Hit& hit) {
    if (!hit.found) return finish(inside_.enclosed() ? Status::kMissingLayer : Status::kOk);
    travel(hit);
    if (geometry_.kind(hit.crossing.object) == SurfaceKind::kRefractive) return cross(hit);
    if (inside_.solid() != kAir) {
        const Hit wall = touching_boundary(geometry_, ray_, hit);  // an object that supports a solid lies outside of it
        if (wall.found && wall.crossing.sense == Sense::kLeaving) {
            standing_.back() = wall.crossing;
            return cross(wall);
        }
    }
    result_.object = std::int32_t(hit.crossing.object);
    result_.position = glm::vec3(hit.position);
    result_.length = float(length_);
    return finish(Status::kOk);
}

}  // namespace pellucid::reference
