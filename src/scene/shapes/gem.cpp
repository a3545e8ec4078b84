// The modern round brilliant: table, stars, mains (kites) and upper girdle facets on the crown; lower girdle facets
// and mains on the pavilion. The free corner of every kite is placed in the kite's plane, so all facets are flat and
// the solid is convex.

#include "scene/shapes/shape_builders.h"

#include <cmath>
#include <numbers>

namespace pellucid {
namespace {

class Brilliant {
public:
    explicit Brilliant(const ShapeArguments& arguments)
        : facets_(arguments.whole("facets")), table_radius_(arguments.number("table")),
          half_girdle_(0.5 * arguments.number("girdle")),
          crown_slope_(std::tan(glm::radians(arguments.number("crown_deg")))),
          pavilion_slope_(std::tan(glm::radians(arguments.number("pavilion_deg")))) {}

    Mesh mesh() const {
        Mesh mesh;
        std::vector<glm::dvec3> table;
        for (int i = 0; i < facets_; ++i) table.push_back(table_corner(i));
        add_facet(mesh, table);
        for (int i = 0; i < facets_; ++i) {
            add_crown(mesh, i);
            add_girdle(mesh, i);
            add_pavilion(mesh, i);
        }
        // Move the origin from the girdle's middle to the middle between culet and table.
        const float middle = float(0.5 * (table_height() + culet().y));
        for (glm::vec3& position : mesh.positions) position.y -= middle;
        return mesh;
    }

private:
    /// Point at an angle in steps of a main facet, counter-clockwise seen from above. Step i + 1/2 lies between main
    /// facets i and i + 1.
    glm::dvec3 at(double step, double radius, double height) const {
        // Equal corners must be equal bit by bit.
        const double angle = 2.0 * std::numbers::pi * std::fmod(step + facets_, facets_) / facets_;
        return {radius * std::cos(angle), height, -radius * std::sin(angle)};
    }
    double cos_half_step() const { return std::cos(std::numbers::pi / facets_); }
    double table_height() const { return half_girdle_ + crown_slope_ * (1.0 - table_radius_); }

    glm::dvec3 table_corner(int i) const { return at(i, table_radius_, table_height()); }
    /// Common corner of two kites, a star and two upper girdle facets.
    glm::dvec3 star_tip(int i) const {
        constexpr double kStarShare = 0.45;  // position between table and girdle along the kite, 0..1
        const double along_kite = table_radius_ + kStarShare * (cos_half_step() - table_radius_);
        return at(i + 0.5, along_kite / cos_half_step(), table_height() - crown_slope_ * (along_kite - table_radius_));
    }
    glm::dvec3 upper_girdle(double step) const { return at(step, 1.0, half_girdle_); }
    glm::dvec3 lower_girdle(double step) const { return at(step, 1.0, -half_girdle_); }
    /// Common corner of two pavilion mains and two lower girdle facets.
    glm::dvec3 pavilion_tip(int i) const {
        constexpr double kTipRadius = 0.25;
        return at(i + 0.5, kTipRadius, culet().y + pavilion_slope_ * kTipRadius * cos_half_step());
    }
    glm::dvec3 culet() const { return {0.0, -half_girdle_ - pavilion_slope_, 0.0}; }

    void add_crown(Mesh& mesh, int i) const {
        add_facet(mesh, {table_corner(i), star_tip(i), table_corner(i + 1)});
        add_facet(mesh, {table_corner(i), star_tip(i - 1), upper_girdle(i), star_tip(i)});
        add_facet(mesh, {star_tip(i), upper_girdle(i), upper_girdle(i + 0.5)});
        add_facet(mesh, {star_tip(i), upper_girdle(i + 0.5), upper_girdle(i + 1)});
    }
    void add_girdle(Mesh& mesh, int i) const {
        for (const double step : {double(i), i + 0.5})
            add_facet(mesh,
                      {upper_girdle(step), lower_girdle(step), lower_girdle(step + 0.5), upper_girdle(step + 0.5)});
    }
    void add_pavilion(Mesh& mesh, int i) const {
        add_facet(mesh, {culet(), pavilion_tip(i), lower_girdle(i), pavilion_tip(i - 1)});
        add_facet(mesh, {pavilion_tip(i), lower_girdle(i + 0.5), lower_girdle(i)});
        add_facet(mesh, {pavilion_tip(i), lower_girdle(i + 1), lower_girdle(i + 0.5)});
    }

    int facets_;
    double table_radius_;
    double half_girdle_;
    double crown_slope_;
    double pavilion_slope_;
};

}  // namespace

Mesh make_gem(const ShapeArguments& arguments) { return Brilliant(arguments).mesh(); }

}  // namespace pellucid
