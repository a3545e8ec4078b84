#include "reference/emitter_sampler.h"

#include "reference/texture_lookup.h"

#include <algorithm>
#include <cmath>

namespace pellucid::reference {
namespace {

bool can_be_chosen(const Geometry& geometry, std::uint32_t object) {
    const Material& material = geometry.material(object);
    if (material.emission == glm::vec3(0.0f)) return false;
    const SurfaceKind kind = geometry.kind(object);
    return kind == SurfaceKind::kThin || (kind == SurfaceKind::kOpaque && !material.unlit);
}

double mean_channel(const glm::vec3& c) { return (double(c.r) + double(c.g) + double(c.b)) / 3.0; }

/// Number of parts along a side of the triangle, such that each part covers about one texel; at most 64.
int parts_along_a_side(const Scene& scene, const Texture& texture, const Mesh& mesh, std::uint32_t triangle) {
    constexpr double kMost = 64.0;
    if (texture.image < 0) return 1;
    const Image& image = scene.images[std::size_t(texture.image)];
    const auto texel_at = [&](const glm::vec2& corner) {
        const SurfaceAttributes attributes = interpolate_attributes(mesh, triangle, corner);
        return glm::dvec2(texture.uv_from_texcoord * glm::vec3(attributes.texcoords[texture.texcoord_set], 1.0f)) *
               glm::dvec2(image.width, image.height);
    };
    const glm::dvec2 a = texel_at({0, 0}), b = texel_at({1, 0}), c = texel_at({0, 1});
    const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    return longest < kMost ? int(std::ceil(longest)) + 1 : int(kMost);
}

/// Mean emission over the centroids of the equal triangles into which lines parallel to the sides divide the triangle.
double mean_emission(const Scene& scene, const Material& material, const Mesh& mesh, std::uint32_t triangle) {
    const int parts = parts_along_a_side(scene, material.emission_texture, mesh, triangle);
    double sum = 0.0;
    const auto look = [&](double u, double v) {
        const glm::vec2 weights = glm::vec2(glm::dvec2(u, v) / double(parts));
        sum += mean_channel(emission(scene, material, interpolate_attributes(mesh, triangle, weights)));
    };
    for (int row = 0; row < parts; ++row) {
        for (int column = 0; row + column < parts; ++column) {
            look(column + 1.0 / 3.0, row + 1.0 / 3.0);
            if (row + column + 1 < parts) look(column + 2.0 / 3.0, row + 2.0 / 3.0);
        }
    }
    return sum / (double(parts) * double(parts));
}

/// Barycentric weights of the second and third vertex for a uniform point.
glm::dvec2 uniform_in_triangle(const glm::dvec2& u) {
    const double root = std::sqrt(u.x);
    return {root * (1.0 - u.y), root * u.y};
}

/// Converts a density per area into one per solid angle, seen from `distance` m away. `normal`: unit, of the surface.
double per_steradian(double per_area, const glm::dvec3& direction, double distance, const glm::dvec3& normal) {
    return per_area * distance * distance / std::abs(glm::dot(direction, normal));
}

}  // namespace

EmitterSampler::EmitterSampler(const Geometry& geometry, const Scene& scene)
    : geometry_(geometry), first_(geometry.object_count(), kNone) {
    for (std::uint32_t object = 0; object < geometry.object_count(); ++object) {
        if (can_be_chosen(geometry, object)) add(scene, object);
    }
    const double power = triangles_.empty() ? 0.0 : triangles_.back().share_up_to;
    if (!(power > 0.0)) triangles_.clear();
    for (Triangle& triangle : triangles_) {
        triangle.share_up_to /= power;
        triangle.density /= power;
    }
}

/// Appends the triangles of an object. Until normalisation, `share_up_to` contains power and `density` emission.
void EmitterSampler::add(const Scene& scene, std::uint32_t object) {
    const Mesh& mesh = geometry_.mesh(object);
    first_[object] = triangles_.size();
    double power = triangles_.empty() ? 0.0 : triangles_.back().share_up_to;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const double area = 0.5 * glm::length(geometry_.at(object, t, 0.0, 0.0).normal);
        const double emitted = area > 0.0 ? mean_emission(scene, geometry_.material(object), mesh, t) : 0.0;
        power += area * emitted;
        triangles_.push_back({object, t, power, emitted});
    }
}

std::optional<EmitterSampler::Sample> EmitterSampler::sample(const glm::dvec3& from, Random& random) const {
    const double share = random.next();
    const auto chosen = std::upper_bound(triangles_.begin(), triangles_.end() - 1, share,
                                         [](double x, const Triangle& triangle) { return x < triangle.share_up_to; });
    const glm::dvec2 weights = uniform_in_triangle(random.next2());
    const Hit point = geometry_.at(chosen->object, chosen->triangle, weights.x, weights.y);
    Sample sample{chosen->object, chosen->triangle, point.position - from};
    sample.distance = glm::length(sample.direction);
    if (!(sample.distance > 0.0)) return std::nullopt;
    sample.direction /= sample.distance;
    const glm::dvec3 normal = geometry_.geometric_normal(point);
    const double facing = -glm::dot(sample.direction, normal);
    if (facing == 0.0 || (facing < 0.0 && geometry_.material(chosen->object).single_sided())) return std::nullopt;
    sample.pdf = per_steradian(chosen->density, sample.direction, sample.distance, normal);
    if (!(sample.pdf > 0.0)) return std::nullopt;
    return sample;
}

double EmitterSampler::pdf(const glm::dvec3& from, const Hit& hit) const {
    const std::size_t first = triangles_.empty() ? kNone : first_[hit.crossing.object];
    if (first == kNone) return 0.0;
    const glm::dvec3 way = hit.position - from;
    const double distance = glm::length(way);
    if (!(distance > 0.0)) return 0.0;
    return per_steradian(triangles_[first + hit.crossing.triangle].density, way / distance, distance,
                         geometry_.geometric_normal(hit));
}

}  // namespace pellucid::reference
