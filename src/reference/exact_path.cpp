#include "reference/exact_path.h"

#include "reference/dielectric.h"

#include <algorithm>
#include <utility>

namespace pellucid::reference {
namespace {

constexpr SurfaceKinds kMet = only(SurfaceKind::kOpaque) | only(SurfaceKind::kRefractive);

glm::dvec3 beer_lambert(const glm::dvec3& sigma_a, double distance) { return glm::exp(-sigma_a * distance); }

}  // namespace

ExactPath::ExactPath(const Geometry& geometry, std::uint32_t max_events)
    : geometry_(geometry), max_events_(max_events), inside_(geometry.solids()), beyond_(geometry.solids()) {}

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
    result_ = {};
    result_.direction = glm::vec3(ray_.direction);
    result_.position = glm::vec3(ray_.origin - ray.before * ray_.direction);
}

bool ExactPath::finish(Status status) {
    result_.status = status;
    result_.direction = glm::vec3(ray_.direction);
    result_.transmittance = glm::vec3(transmittance_);
    result_.length_inside = float(length_inside_);
    return false;
}

/// The boundary of another solid at the very place of `hit`, on which the path stands. Where solids
/// touch, the order in which their surfaces are found is chance.
Hit ExactPath::touching(const Hit& hit) const {
    if (!geometry_.touches_others(hit.crossing.object)) return {};
    const double apart = geometry_.coincidence();
    Query query = ray_;
    query.t_max = apart / std::abs(glm::dot(ray_.direction, geometry_.geometric_normal(hit)));
    query.kinds = only(SurfaceKind::kRefractive);
    const Hit other = geometry_.intersect(query);
    if (!other.found || other.crossing.object == hit.crossing.object) return {};
    const double distance = glm::dot(other.position - hit.position, geometry_.geometric_normal(other));
    return std::abs(distance) <= apart ? other : Hit{};
}

/// Goes straight on to what was met.
void ExactPath::travel(const Hit& hit) {
    length_ += hit.t;
    if (inside_.object() != kAir) {
        length_inside_ += hit.t;
        transmittance_ *= beer_lambert(inside_.medium().sigma_a, hit.t);
    }
    ray_.origin = hit.position;
    ray_.t_max = std::numeric_limits<double>::infinity();  // the camera's planes cut off what it sees first
    geometry_.step_onto(hit, standing_);
    ray_.standing = standing_;
}

/// Of the boundaries being met, the one between the two media: that of the solid that displaces the other.
const Hit& ExactPath::displacing() const {
    const auto rank = [&](const Hit& hit) {
        const std::uint32_t object = hit.crossing.object;
        const bool between = std::int32_t(object) == inside_.object() || std::int32_t(object) == beyond_.object();
        return between ? std::int64_t(geometry_.solids()[object].precedence) : -1;
    };
    return *std::max_element(boundaries_.begin(), boundaries_.end(),
                             [&](const Hit& a, const Hit& b) { return rank(a) < rank(b); });
}

/// Refracts or totally reflects the path at an interface. The interpolated normal may send a reflected
/// path through the triangle (1 to 4 in 100 reflections in scanned or modelled animals): it leaks out,
/// and cross() puts it on the far side.
void ExactPath::bend(const Hit& hit) {
    const double n_i = inside_.medium().ior, n_t = beyond_.medium().ior;
    const glm::dvec3 outward = geometry_.shading_normal(hit);
    const glm::dvec3 normal = hit.crossing.sense == Sense::kEntering ? outward : -outward;
    const Incidence in = incidence(ray_.direction, normal, n_i, n_t);
    if (in.total) {
        ray_.direction = reflected(ray_.direction, normal, in);
        ++result_.reflections;
    } else {
        ray_.direction = refracted(ray_.direction, normal, n_i, n_t, in);
        transmittance_ *= 1.0 - in.reflectance;
    }
    ++result_.events;
    result_.side_conflict = result_.side_conflict || in.conflict;
    result_.position = glm::vec3(hit.position);
    result_.length = float(length_);
    for (Crossing& on : standing_) on.sense = geometry_.sense(on.object, on.triangle, ray_.direction);
}

/// Meets the boundary of a solid, and those of others that touch it there.
bool ExactPath::cross(const Hit& hit) {
    boundaries_.assign(1, hit);
    if (geometry_.touches_others(hit.crossing.object)) {
        for (Hit next = touching(hit); next.found; next = touching(hit)) {
            boundaries_.push_back(next);
            standing_.push_back(next.crossing);
            ray_.standing = standing_;
        }
    }
    beyond_ = inside_;
    for (const Hit& boundary : boundaries_) {
        const auto [object, triangle, sense] = boundary.crossing;
        // An open surface met from behind: its normal alone says that the path was inside.
        if (!geometry_.solids()[object].closed) inside_.set(object, sense == Sense::kLeaving ? 1 : 0);
        beyond_.cross(object, sense);
    }
    bool through = true;
    if (beyond_.object() != inside_.object()) {
        if (result_.events == max_events_) return finish(Status::kEventLimit);
        const Hit& interface = displacing();
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
    if (inside_.object() != kAir) {
        const Hit wall = touching(hit);  // what a solid stands on is outside of it
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
