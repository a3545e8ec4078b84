#pragma once

// The scene's triangles in world space, and rays that find them.
//
// Embree searches in single precision; what it finds is decided and located again in double precision,
// from the triangle's vertices alone. So no surface is kept at a distance by an epsilon:
//
// 1. A ray does not meet the triangle that it stands on.
// 2. It meets a triangle that shares a vertex with that one, and is crossed in the same sense, only if
//    it passes through its inside, some way ahead: near an edge one surface is not entered twice. (After
//    a reflection the ray runs as if it had just come in through the triangle it was reflected at.)
// 3. A surface is ahead if its plane is not behind the origin by more than the rounding error of the
//    origin, which is derived in geometry_search.cpp: a few 1e-15 of the coordinates within one shell,
//    whose triangles share their vertices exactly; the contact distance between shells, whose vertices
//    were rounded to float each on its own (two solids that touch).
//
// Nothing else is turned down, so that the crossings of a path add up to its winding number about a
// closed surface even where that surface passes through itself.

#include "reference/media.h"

#include <pellucid/reference.h>
#include <pellucid/scene.h>

#include <embree3/rtcore.h>

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace pellucid::reference {

/// What light does at a surface, by its material.
enum class SurfaceKind : std::uint8_t {
    kOpaque = 1,     ///< a path of exact refraction ends here; alpha below the cutoff is a hole, as in kThin
    kThin = 2,       ///< transmissive without thickness: light passes straight on
    kRefractive = 4  ///< boundary of a solid of glass
};
using SurfaceKinds = std::uint8_t;  ///< a set of them, as bits
inline constexpr SurfaceKinds kAllSurfaces = 7;
constexpr SurfaceKinds only(SurfaceKind kind) { return SurfaceKinds(kind); }

/// A triangle of an object, as a ray crosses it.
struct Crossing {
    std::uint32_t object = 0;    ///< Scene::objects
    std::uint32_t triangle = 0;  ///< Mesh::triangles
    Sense sense = Sense::kEntering;
    std::uint32_t shell = 0;  ///< Geometry::solid_of()
};

/// A ray, and what it may meet.
struct Query {
    glm::dvec3 origin{0.0};                                  ///< world, m
    glm::dvec3 direction{0.0};                               ///< unit
    double t_max = std::numeric_limits<double>::infinity();  ///< m
    /// Triangles that the origin lies on, with the sense in which `direction` crosses them.
    std::span<const Crossing> standing;
    SurfaceKinds kinds = kAllSurfaces;
};

/// The nearest surface that a ray meets.
struct Hit {
    bool found = false;
    Crossing crossing;
    double t = 0.0;            ///< m along the ray, >= 0
    glm::dvec3 position{0.0};  ///< world, on the triangle to within double precision
    double u = 0.0, v = 0.0;   ///< barycentric weights of the triangle's second and third vertex
    glm::dvec3 normal{0.0};    ///< of the triangle, outward, twice its area long
};

/// Sense in which `direction` crosses a triangle with that outward normal, of any length.
inline Sense crossing_sense(const glm::dvec3& direction, const glm::dvec3& normal) {
    return glm::dot(direction, normal) < 0.0 ? Sense::kEntering : Sense::kLeaving;
}

/// Triangles of a scene in world space under one Embree hierarchy. Queries are safe from any thread;
/// update() is not.
class Geometry {
public:
    /// `scene` must be checked and outlive the geometry, which reads its triangles and
    /// textures in place. Throws Error if Embree cannot build.
    Geometry(const Scene& scene, const TracerOptions& options);

    /// Nearest surfaces. Rays of one call are traced as a packet: `queries` holds 1, 4, 8 or 16, and
    /// those with active[i] == 0 are left out. Directions should be alike for speed; results do not
    /// depend on what is traced together.
    void intersect(std::span<const Query> queries, std::span<const int> active, std::span<Hit> hits) const;
    Hit intersect(const Query& query) const;
    /// True if there is a surface before query.t_max.
    bool occluded(const Query& query) const;

    SurfaceKind kind(std::uint32_t object) const { return objects_[object].kind; }
    std::span<const Solid> solids() const { return solids_; }  ///< two per body: its closed and its open shells
    std::uint32_t shell(std::uint32_t object, std::uint32_t triangle) const {
        return objects_[object].facets[triangle].shell;
    }
    /// Solid that a shell bounds; there is none of what does not refract.
    std::uint32_t solid_of(std::uint32_t shell) const { return shells_[shell].solid; }
    std::uint32_t object_count() const { return std::uint32_t(objects_.size()); }
    const Material& material(std::uint32_t object) const;
    struct Box {
        glm::dvec3 low, high;  ///< world, m
    };
    Box box(std::uint32_t object) const { return {objects_[object].low, objects_[object].high}; }
    const Mesh& mesh(std::uint32_t object) const;

    /// The point of a triangle at barycentric weights, as hit from outside.
    Hit at(std::uint32_t object, std::uint32_t triangle, double u, double v) const;
    /// Sense in which `direction` crosses a triangle.
    Sense sense(std::uint32_t object, std::uint32_t triangle, const glm::dvec3& direction) const;
    /// Outward unit normal of the triangle itself (0 if it has no area).
    glm::dvec3 geometric_normal(const Hit& hit) const;
    /// Outward unit normal, interpolated between the vertices.
    glm::dvec3 shading_normal(const Hit& hit) const;

    /// What a search in single precision needs: the hierarchy, whose geometries are the objects and which has no
    /// filter function of its own; the largest magnitude of any coordinate, m; and an object's triangles.
    RTCScene hierarchy() const { return embree_.get(); }
    double scale() const { return scale_; }
    bool mirrored(std::uint32_t object) const { return objects_[object].mirrored; }
    /// update() has moved its vertices.
    bool has_moved(std::uint32_t object) const { return objects_[object].has_moved; }
    const std::array<glm::vec3, 3>& corner_positions(std::uint32_t object, std::uint32_t triangle) const {
        return objects_[object].facets[triangle].corners;
    }
    /// Takes a direction of the object's mesh to the world.
    glm::dmat3 to_world(std::uint32_t object) const { return glm::dmat3(scene_.objects[object].world_from_object); }
    glm::vec3 unnormalized_normal(std::uint32_t object, std::uint32_t triangle, float u, float v) const {
        const auto& [n0, n1, n2] = objects_[object].facets[triangle].normals;
        return (1.0f - u - v) * n0 + u * n1 + v * n2;
    }
    /// True where the surface has a hole by its alpha. Of one that is half there, every ray with weights of its own sees
    /// a hole or not, by chance.
    bool cut_out(std::uint32_t object, std::uint32_t triangle, double u, double v) const;

    /// Distance, m, to which surfaces anywhere in the scene can be told apart: the rounding of their world coordinates
    /// to float.
    double coincidence() const;
    /// Surfaces of two shells no farther apart than this, m, are at the same place: 1e-6 of the larger body's extent, and
    /// at least four spacings of a float there.
    double contact(std::uint32_t shell_a, std::uint32_t shell_b, const glm::dvec3& place) const;
    double widest_contact() const { return widest_contact_; }  ///< m, of any two shells anywhere

    /// False if the shell's box is apart from all others: then no surface lies at the same place.
    bool touches_others(std::uint32_t shell) const { return shells_[shell].touches; }
    /// Takes a path that stands on the triangles `standing` on to `hit`: it then stands on that, and
    /// still on those of other shells that lie at the same place. For a new direction their senses
    /// must be made anew.
    void step_onto(const Hit& hit, std::vector<Crossing>& standing) const;

    /// The solids around a point, counted along one straight line to infinity.
    MediumStack solids_around(const glm::dvec3& point) const;
    /// True if no refractive object's box reaches into the box from `low` to `high`.
    bool in_air(const glm::dvec3& low, const glm::dvec3& high) const;

    /// See Tracer::set_positions.
    void update(std::span<const MovedMesh> moved, Tracer::Update update);
    double build_ms() const { return build_ms_; }

private:
    /// What a path reads of a triangle, in two cache lines: it meets triangles in an order that no
    /// cache foresees, and waits for each line.
    struct alignas(32) Facet {
        std::array<glm::vec3, 3> corners;  ///< world
        std::array<glm::vec3, 3> normals;  ///< of the vertices: world, unit, outward
        glm::uvec3 vertices;               ///< welded by position, in their body
        std::uint32_t shell = 0;           ///< shells_
    };
    static constexpr double kContact = 1e-6;  // of a body's extent
    static constexpr std::uint32_t kNoSolid = ~0u;
    /// A shell of a body; or all of an object that does not refract.
    struct ShellRecord {
        std::uint32_t solid = kNoSolid;
        std::uint32_t body = 0;  ///< extents_
        bool touches = false;    ///< another shell's box, within the contact distance
        glm::dvec3 low{0.0}, high{0.0};
    };
    struct Object {
        SurfaceKind kind = SurfaceKind::kOpaque;
        bool mirrored = false;             ///< world_from_object mirrors, so winding is reversed
        bool single_sided = false;         ///< opaque, and not there for rays that come from behind
        bool has_holes = false;            ///< alpha leaves some points out
        bool has_moved = false;            ///< see has_moved()
        std::vector<glm::vec3> positions;  ///< world; one more than there are, which Embree may read
        std::vector<Facet> facets;         ///< per triangle
        glm::dvec3 low{0.0}, high{0.0};    ///< box, world
    };
    struct Release {
        void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    };
    struct Corners {
        glm::dvec3 p0, p1, p2;
        glm::dvec3 normal;  ///< outward, twice the area long
        glm::dvec2 weights(const glm::dvec3& origin, const glm::dvec3& direction) const;
    };

    Corners corners(std::uint32_t object, std::uint32_t triangle) const {
        const Object& o = objects_[object];
        const auto& [p0, p1, p2] = o.facets[triangle].corners;
        Corners c{p0, p1, p2, {}};
        c.normal = glm::cross(c.p1 - c.p0, c.p2 - c.p0);
        if (o.mirrored) c.normal = -c.normal;
        return c;
    }
    bool accepts(const Query& query, std::uint32_t object, std::uint32_t triangle) const;
    Hit locate(const Query& query, std::uint32_t object, std::uint32_t triangle) const;
    RTCRay embree_ray(const Query& query, unsigned id) const;
    template <int N>
    void intersect_packet(std::span<const Query> queries, std::span<const int> active, std::span<Hit> hits) const;
    static void filter(const RTCFilterFunctionNArguments* arguments);

    void check_moved(const MovedMesh& moved) const;
    void number_shells();
    void place(std::uint32_t object, std::span<const glm::vec3> positions, std::span<const glm::vec3> normals);
    void attach(std::uint32_t object);
    void measure_shells();
    void find_touching();
    void commit();

    const Scene& scene_;
    TracerOptions options_;
    std::vector<Object> objects_;
    std::vector<Solid> solids_;
    std::vector<ShellRecord> shells_;
    std::vector<double> extents_;  ///< of bodies, m: the longest side of the box
    double scale_ = 0.0;           ///< largest magnitude of any coordinate, m
    double widest_contact_ = 0.0;
    double build_ms_ = 0.0;
    std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release> device_;
    std::unique_ptr<std::remove_pointer_t<RTCScene>, Release> embree_;
};

}  // namespace pellucid::reference
