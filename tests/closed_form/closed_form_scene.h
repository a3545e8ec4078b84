#pragma once

// Exact paths through balls and boxes, from closed formulas. The code shares nothing with the library: it finds the
// interval of every shell along a ray and counts them, so it has no triangles, no hierarchy and no state to lose.
//
// The rules: a body is the union of its shells by winding number, the body of the highest
// priority fills a point, then the smaller, then the later. Surfaces in contact are one.
#include <glm/glm.hpp>

#include <string>
#include <vector>

namespace pellucid::closed_form {

enum class ShellKind { kBall, kBox };

/// A closed surface: the affine image of the unit ball or of the cube -1..1.
struct Shell {
    ShellKind kind = ShellKind::kBall;
    glm::dmat4 world_from_shell{1.0};
    int winding = 1;  ///< 1: outward; -1: a cavity
};

struct Medium {
    double ior = 1.0;
    glm::dvec3 sigma_a{0.0};  ///< absorption coefficient, 1/m
    bool operator==(const Medium& other) const = default;
};

struct Body {
    std::vector<Shell> shells;
    Medium medium;
    int priority = 0;
    /// Volume where the winding number is above 0, m3. Of two bodies the smaller wins, unless they are within 1e-4.
    double volume = 0.0;
};

struct Ray {
    glm::dvec3 origin{0.0};           ///< world, m
    glm::dvec3 direction{0.0, 0, 1};  ///< unit
};

/// A camera that looks along its own -Z.
struct View {
    glm::dmat4 world_from_view{1.0};
    bool orthographic = false;
    double vertical_fov = 0.5;     ///< radians
    double vertical_extent = 2.0;  ///< m; orthographic
    /// Ray through a point of a square image of `size` pixels; (0.5, 0.5) is the centre of the first pixel.
    Ray ray(glm::dvec2 point_px, int size) const;
};

inline constexpr int kOutside = -1;

/// A change of medium on a path.
struct Event {
    int before = kOutside, after = kOutside;  ///< bodies, or kOutside
    bool total = false;                       ///< totally reflected: the path stays in `before`
    glm::dvec3 position{0.0};                 ///< world, m
};

struct Path {
    std::vector<Event> events;
    glm::dvec3 direction{0.0};      ///< unit, after the last event
    glm::dvec3 transmittance{1.0};  ///< product of 1 - Fresnel reflectance and of absorption up to the last event
    double length = 0.0;            ///< m, from the eye to the last event
    double length_inside = 0.0;     ///< m, inside bodies
    bool cut = false;               ///< there are more events than were asked for
    int reflections() const;
};

class Scene {
public:
    explicit Scene(std::vector<Body> bodies);
    const std::vector<Body>& bodies() const { return bodies_; }

    /// Body that fills a point, or kOutside.
    int body_at(const glm::dvec3& point) const;
    /// Winding number of each body around a point.
    std::vector<int> windings(const glm::dvec3& point) const;
    /// Refracts at each interface, or totally reflects, at most `max_events` times.
    Path trace(const Ray& ray, int max_events) const;

private:
    struct Crossing {
        double t;
        double cos_theta;  ///< between ray and surface, 0..1
        int body;
        glm::dvec3 normal;  ///< unit, out of the shell
    };
    /// A stretch of a ray between two contacts.
    struct Interface {
        bool found = false;
        double t = 0.0;
        int before = kOutside, after = kOutside;
        glm::dvec3 normal{0.0};
    };

    const Medium& medium(int body) const;
    std::vector<Crossing> crossings(const Ray& ray) const;
    bool in_contact(const Crossing& a, const Crossing& b) const;
    Interface next_interface(const Ray& ray, const Crossing* start) const;

    std::vector<Body> bodies_;
    std::vector<std::vector<glm::dmat4>> shell_from_world_;
    std::vector<double> extents_;  ///< of each body, m
    std::vector<int> rank_;        ///< of each body; the highest fills a point
};

/// Volume where the winding number of `shells` is above 0. Exact for one shell; else counted in `cells`^3 cells of the
/// bounding box, which is good to about 1 / cells^2 of the box.
double material_volume(const std::vector<Shell>& shells, int cells = 96);

/// Half the sides of a shell's bounding box.
glm::dvec3 half_box(const Shell& shell);
/// True inside the shell, whatever its winding.
bool contains(const Shell& shell, const glm::dvec3& point);

/// One line: bodies in their order, positions, reflections.
std::string to_string(const Path& path);

}  // namespace pellucid::closed_form
