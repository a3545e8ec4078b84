// Finding the nearest triangle; see geometry.h for the rules.
//
// Rounding. Let u = 2^-53, gamma(n) = n u / (1 - n u) (Higham, Accuracy and Stability of Numerical
// Algorithms, 2nd ed. 2002, section 3.1), and S the largest magnitude of any coordinate. A position
// interpolated with weights 1 - u - v, u, v is off by at most gamma(6) S in each coordinate. Against a
// triangle with edges e1, e2 from p0 and N = e1 x e2 we compare (p0 - o).N with 0. Its error is at most
//     gamma(6) S |N|_1              from o,
//     gamma(4) |p0 - o| |N|         from the difference and the product,
//     gamma(6) |p0 - o| |e1| |e2|   from the cross product,
// and with |p0 - o| <= 2 S in each coordinate and |N| <= |e1| |e2| less than gamma(32) S |e1|_1 |e2|_1.
// For a sliver that is much compared with S |N|: there the plane itself is known no better.
//
// Positions in the world are rounded to float, by half of 2^-23 S. Two surfaces that were made to touch
// are apart by up to twice that in each coordinate, so by less than 4 * 2^-24 S: the coincidence. What
// counts as touching is wider than that, so that files need not be made to the last digit: contact().
#include "reference/geometry.h"
#include "reference/texture_lookup.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>

namespace pellucid::reference {
namespace {

constexpr double kGamma32 = 32.0 * 0x1p-53 / (1.0 - 32.0 * 0x1p-53);

/// The search in single precision starts this many coincidences behind the origin, so that it finds
/// what is ahead of it whichever way the ray was rounded; what it finds behind is turned down exactly.
constexpr double kStartBehind = 64.0;

double norm1(const glm::dvec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

bool share_vertex(const glm::uvec3& a, const glm::uvec3& b) {
    const auto is_in_b = [&](std::uint32_t vertex) { return vertex == b.x || vertex == b.y || vertex == b.z; };
    return is_in_b(a.x) || is_in_b(a.y) || is_in_b(a.z);
}

/// Whether barycentric weights are those of a point in the triangle.
bool within(const glm::dvec2& weights) { return weights.x >= 0.0 && weights.y >= 0.0 && weights.x + weights.y <= 1.0; }

struct Context {
    RTCIntersectContext embree;  // first: Embree hands out its address
    const Geometry* geometry;
    const Query* queries;
};

Context make_context(const Geometry& geometry, const Query* queries, RTCFilterFunctionN filter) {
    Context context{};
    rtcInitIntersectContext(&context.embree);
    context.embree.filter = filter;
    context.geometry = &geometry;
    context.queries = queries;
    return context;
}

template <int N>
struct Packet;
template <>
struct Packet<4> {
    using RayHit = RTCRayHit4;
    static constexpr auto kIntersect = rtcIntersect4;
};
template <>
struct Packet<8> {
    using RayHit = RTCRayHit8;
    static constexpr auto kIntersect = rtcIntersect8;
};
template <>
struct Packet<16> {
    using RayHit = RTCRayHit16;
    static constexpr auto kIntersect = rtcIntersect16;
};

std::uint64_t mixed(std::uint64_t h) {
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ull;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebull;
    return h ^ (h >> 31);
}

/// A number 0..1 without 1 of a point of a triangle, without a relation to those of its neighbours.
double number_of(std::uint32_t triangle, double u, double v) {
    const std::uint64_t point = mixed(std::bit_cast<std::uint64_t>(u) + 0x9e3779b97f4a7c15ull * triangle);
    return double(mixed(point ^ std::bit_cast<std::uint64_t>(v)) >> 11) * 0x1p-53;
}

}  // namespace

Sense Geometry::sense(std::uint32_t object, std::uint32_t triangle, const glm::dvec3& direction) const {
    return crossing_sense(direction, corners(object, triangle).normal);
}

glm::dvec3 Geometry::geometric_normal(const Hit& hit) const {
    const double length = glm::length(hit.normal);
    return length > 0.0 ? hit.normal / length : hit.normal;
}

glm::dvec3 Geometry::shading_normal(const Hit& hit) const {
    const auto& [n0, n1, n2] = objects_[hit.crossing.object].facets[hit.crossing.triangle].normals;
    const glm::dvec3 n = (1.0 - hit.u - hit.v) * glm::dvec3(n0) + hit.u * glm::dvec3(n1) + hit.v * glm::dvec3(n2);
    const double length = glm::length(n);
    return length > 0.0 ? n / length : geometric_normal(hit);  // opposite normals cancel
}

double Geometry::coincidence() const { return 4.0 * 0x1p-24 * scale_; }

double Geometry::contact(std::uint32_t shell_a, std::uint32_t shell_b, const glm::dvec3& place) const {
    const double extent = std::max(extents_[shells_[shell_a].body], extents_[shells_[shell_b].body]);
    const double largest = std::max({std::abs(place.x), std::abs(place.y), std::abs(place.z)});
    return std::max(kContact * extent, 4.0 * 0x1p-23 * largest);
}

bool Geometry::cut_out(std::uint32_t object, std::uint32_t triangle, double u, double v) const {
    if (!objects_[object].has_holes) return false;
    const SurfaceAttributes attributes = interpolate_attributes(mesh(object), triangle, {float(u), float(v)});
    const Material& m = material(object);
    const float alpha = base_color(scene_, m, attributes).a;
    if (m.alpha_is_coverage && objects_[object].kind == SurfaceKind::kOpaque)
        return double(alpha) <= number_of(triangle, u, v);
    return alpha < m.alpha_cutoff;
}

/// Barycentric weights of the second and third vertex where the line of the ray meets the plane.
glm::dvec2 Geometry::Corners::weights(const glm::dvec3& origin, const glm::dvec3& direction) const {
    const glm::dvec3 q = origin + glm::dot(p0 - origin, normal) / glm::dot(direction, normal) * direction - p0;
    const glm::dvec3 n = glm::cross(p1 - p0, p2 - p0);  // not turned outwards
    return glm::dvec2(glm::dot(glm::cross(q, p2 - p0), n), glm::dot(glm::cross(p1 - p0, q), n)) / glm::dot(n, n);
}

/// The three rules, and what the caller asked for.
bool Geometry::accepts(const Query& query, std::uint32_t object, std::uint32_t triangle) const {
    const Object& o = objects_[object];
    const SurfaceKind surface = o.kind;
    if ((query.kinds & only(surface)) == 0) return false;
    const auto is_this = [&](const Crossing& on) { return on.object == object && on.triangle == triangle; };
    if (std::any_of(query.standing.begin(), query.standing.end(), is_this)) return false;
    const Corners c = corners(object, triangle);
    const double speed = glm::dot(query.direction, c.normal);  // along the normal
    if (speed == 0.0) return false;
    const Sense sense = speed < 0.0 ? Sense::kEntering : Sense::kLeaving;
    if (o.single_sided && sense == Sense::kLeaving) return false;

    const double ahead = std::copysign(1.0, speed) * glm::dot(c.p0 - query.origin, c.normal);
    const double rounding = kGamma32 * scale_ * norm1(c.p1 - c.p0) * norm1(c.p2 - c.p0);
    const Facet& facet = o.facets[triangle];
    bool same_shell = query.standing.empty();
    for (const Crossing& on : query.standing) {
        if (on.shell != facet.shell) continue;
        same_shell = true;
        if (on.sense == sense && share_vertex(objects_[on.object].facets[on.triangle].vertices, facet.vertices) &&
            (ahead <= rounding || !within(c.weights(query.origin, query.direction)))) {
            return false;
        }
    }
    if (same_shell) {
        if (ahead < -rounding) return false;
    } else {
        double touch = 0.0;
        for (const Crossing& on : query.standing)
            touch = std::max(touch, contact(on.shell, facet.shell, query.origin) * glm::length(c.normal));
        if (ahead < -std::max(touch, rounding)) return false;
        // What a solid stands on lies outside of it, however the two were rounded.
        const bool leaves_no_solid = query.standing.back().sense == Sense::kEntering;
        if (surface != SurfaceKind::kRefractive && ahead < touch && leaves_no_solid) return false;
    }
    return ahead <= query.t_max * std::abs(speed);
}

void Geometry::filter(const RTCFilterFunctionNArguments* arguments) {
    const auto& context = *reinterpret_cast<const Context*>(arguments->context);
    const unsigned count = arguments->N;
    for (unsigned i = 0; i < count; ++i) {
        if (arguments->valid[i] == 0) continue;
        const Query& query = context.queries[RTCRayN_id(arguments->ray, count, i)];
        const std::uint32_t object = RTCHitN_geomID(arguments->hit, count, i);
        const std::uint32_t triangle = RTCHitN_primID(arguments->hit, count, i);
        if (!context.geometry->accepts(query, object, triangle) ||
            context.geometry->cut_out(object, triangle, double(RTCHitN_u(arguments->hit, count, i)),
                                      double(RTCHitN_v(arguments->hit, count, i)))) {
            arguments->valid[i] = 0;
        }
    }
}

RTCRay Geometry::embree_ray(const Query& query, unsigned id) const {
    const double behind = query.standing.empty() ? 0.0 : kStartBehind * coincidence();
    const glm::vec3 origin(query.origin - behind * query.direction);
    const glm::vec3 direction(query.direction);
    RTCRay ray{};
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    // Its end is decided in double precision, too.
    ray.tfar = float(query.t_max + behind + kStartBehind * coincidence());
    ray.mask = ~0u;
    ray.id = id;
    return ray;
}

/// Where the ray meets the triangle, in double precision. Single precision may have found it a little
/// beyond an edge; then the nearest point of the triangle is taken, so that a neighbour beyond that
/// edge is not behind the ray.
Hit Geometry::locate(const Query& query, std::uint32_t object, std::uint32_t triangle) const {
    const Corners c = corners(object, triangle);
    Hit hit;
    hit.found = true;
    hit.crossing = {object, triangle, crossing_sense(query.direction, c.normal),
                    objects_[object].facets[triangle].shell};
    hit.normal = c.normal;
    const glm::dvec2 weights = glm::max(c.weights(query.origin, query.direction), glm::dvec2(0.0));
    const glm::dvec2 inside = weights / std::max(weights.x + weights.y, 1.0);
    hit.u = inside.x;
    hit.v = inside.y;
    hit.position = (1.0 - hit.u - hit.v) * c.p0 + hit.u * c.p1 + hit.v * c.p2;
    hit.t = std::max(glm::dot(hit.position - query.origin, query.direction), 0.0);
    return hit;
}

Hit Geometry::intersect(const Query& query) const {
    Context context = make_context(*this, &query, filter);
    RTCRayHit ray_hit{};
    ray_hit.ray = embree_ray(query, 0);
    ray_hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(embree_.get(), &context.embree, &ray_hit);
    if (ray_hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return locate(query, ray_hit.hit.geomID, ray_hit.hit.primID);
}

bool Geometry::occluded(const Query& query) const {
    Context context = make_context(*this, &query, filter);
    RTCRay ray = embree_ray(query, 0);
    rtcOccluded1(embree_.get(), &context.embree, &ray);
    return ray.tfar < 0.0f;
}

template <int N>
void Geometry::intersect_packet(std::span<const Query> queries, std::span<const int> active,
                                std::span<Hit> hits) const {
    Context context = make_context(*this, queries.data(), filter);
    alignas(64) typename Packet<N>::RayHit packet{};
    alignas(64) std::array<int, N> valid{};
    for (unsigned i = 0; i < N; ++i) {
        packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        if (active[i] == 0) continue;
        valid[i] = -1;
        const RTCRay ray = embree_ray(queries[i], i);
        packet.ray.org_x[i] = ray.org_x;
        packet.ray.org_y[i] = ray.org_y;
        packet.ray.org_z[i] = ray.org_z;
        packet.ray.dir_x[i] = ray.dir_x;
        packet.ray.dir_y[i] = ray.dir_y;
        packet.ray.dir_z[i] = ray.dir_z;
        packet.ray.tfar[i] = ray.tfar;
        packet.ray.mask[i] = ray.mask;
        packet.ray.id[i] = ray.id;
    }
    Packet<N>::kIntersect(valid.data(), embree_.get(), &context.embree, &packet);
    for (unsigned i = 0; i < N; ++i) {
        hits[i] = packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID
                      ? Hit{}
                      : locate(queries[i], packet.hit.geomID[i], packet.hit.primID[i]);
    }
}

void Geometry::intersect(std::span<const Query> queries, std::span<const int> active, std::span<Hit> hits) const {
    assert(active.size() == queries.size() && hits.size() == queries.size());
    switch (queries.size()) {
        case 1:
            hits[0] = active[0] != 0 ? intersect(queries[0]) : Hit{};
            break;
        case 4:
            intersect_packet<4>(queries, active, hits);
            break;
        case 8:
            intersect_packet<8>(queries, active, hits);
            break;
        default:
            assert(queries.size() == 16);
            intersect_packet<16>(queries, active, hits);
    }
}

void Geometry::step_onto(const Hit& hit, std::vector<Crossing>& standing) const {
    // Within one shell positions are exact, so only the last triangle counts; two reflections in the tip
    // of a wedge can be all but as close as they like. A path that did not move at all keeps the others:
    // on an edge it would go round them for ever.
    const bool moved = hit.t > kGamma32 * scale_;
    std::erase_if(standing, [&](const Crossing& on) {
        if (on.shell == hit.crossing.shell) return moved;
        const Corners c = corners(on.object, on.triangle);
        return std::abs(glm::dot(hit.position - c.p0, c.normal)) >
               contact(on.shell, hit.crossing.shell, hit.position) * glm::length(c.normal);
    });
    standing.push_back(hit.crossing);
}

MediumStack Geometry::solids_around(const glm::dvec3& point) const {
    MediumStack solids(solids_);
    if (in_air(point, point)) return solids;
    std::vector<Crossing> standing;
    Query query;
    query.origin = point;
    query.direction = glm::normalize(glm::dvec3(0.4321, 0.7537, 0.4952));  // along no axis or diagonal
    query.kinds = only(SurfaceKind::kRefractive);
    for (;;) {
        query.standing = standing;
        const Hit hit = intersect(query);
        if (!hit.found) return solids;
        const std::uint32_t solid = solid_of(hit.crossing.shell);
        if (solids_[solid].closed) {  // every boundary that is left now was entered before the point
            solids.set(solid, solids.count(solid) + (hit.crossing.sense == Sense::kLeaving ? 1 : -1));
        }
        step_onto(hit, standing);
        query.origin = hit.position;
    }
}

}  // namespace pellucid::reference
