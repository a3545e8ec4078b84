#include "closed_form/solid_kinds.h"

#include "closed_form/random_solids.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <functional>
#include <utility>

namespace pellucid::test {
namespace {

using closed_form::Medium;
using closed_form::Shell;
using closed_form::ShellKind;
using closed_form::View;

const Medium kGlass{1.5, {0.4, 0.2, 0.1}}, kWater{1.33, {0.0, 0.0, 0.0}}, kFlint{1.8, {0.1, 0.3, 0.2}},
    kAir{1.0, {0, 0, 0}};

Shell shell(ShellKind kind, glm::dvec3 center, glm::dvec3 half, int winding = 1) {
    return {kind, glm::scale(glm::translate(glm::dmat4(1.0), center), half), winding};
}
Shell ball(glm::dvec3 center, double radius, int winding = 1) {
    return shell(ShellKind::kBall, center, glm::dvec3(radius), winding);
}
Shell box(glm::dvec3 center, glm::dvec3 half) { return shell(ShellKind::kBox, center, half); }

PlannedSolid solid(std::vector<Shell> shells, const Medium& medium, int priority = 0, int primitives = 1) {
    PlannedSolid planned;
    for (const Shell& each : shells) planned.shells.push_back({each});
    planned.medium = medium;
    planned.priority = priority;
    planned.primitives = primitives;
    return planned;
}

struct Kind {
    std::string name;
    std::vector<PlannedSolid> solids;
    glm::dvec3 inside;  ///< a point in glass, off all surfaces
};

std::vector<Kind> kinds() {
    std::vector<Kind> all;
    all.push_back(
        {"overlapping balls", {solid({ball({-0.3, 0, 0}, 0.6), ball({0.35, 0.1, 0}, 0.55)}, kGlass)}, {0.05, 0, 0.1}});
    PlannedSolid joined =
        solid({ball({-0.3, 0, 0}, 0.6), ball({0.35, 0.1, 0}, 0.55), box({0, 0.5, 0}, {0.2, 0.4, 0.2})}, kGlass);
    joined.bridged = true;
    all.push_back({"crossing itself", {joined, solid({ball({-0.4, 0, 0}, 0.2)}, kFlint)}, {0.05, 0, 0.1}});
    all.push_back({"touching boxes",
                   {solid({box({-0.5, 0, 0}, {0.5, 0.4, 0.5}), box({0.4, 0.1, 0.05}, {0.4, 0.5, 0.45})}, kGlass, 0, 2)},
                   {-0.3, 0.05, 0.1}});
    all.push_back({"nested shells and solids",
                   {solid({ball({0, 0, 0}, 0.9), box({0.1, 0, 0}, {0.3, 0.3, 0.3})}, kGlass),
                    solid({ball({-0.35, 0.1, 0.2}, 0.3)}, kFlint)},
                   {0.5, 0.1, 0.3}});
    all.push_back(
        {"hollow filled with water",
         {solid({ball({0, 0, 0}, 0.9), ball({0, 0, 0}, 0.7, -1)}, kGlass), solid({ball({0, 0, 0}, 0.7)}, kWater)},
         {0.2, 0.1, 0.3}});
    PlannedSolid twice = solid({box({0, 0, 0}, {0.6, 0.5, 0.4})}, kGlass);
    twice.shells[0].written_twice = true;
    all.push_back({"duplicates", {twice, solid({box({0, 0, 0}, {0.6, 0.5, 0.4})}, kFlint, 0, 3)}, {0.1, 0.1, 0.1}});
    PlannedSolid inverted =
        solid({ball({-0.45, 0, 0}, 0.5), ball({0.5, 0.1, 0}, 0.45), box({0, -0.6, 0}, {0.9, 0.2, 0.4})}, kGlass);
    inverted.shells[1].written_inside_out = true;
    inverted.shells[2].written_inside_out = true;
    all.push_back({"shells inside out", {inverted}, {-0.4, 0.1, 0.1}});
    all.push_back(
        {"rod in a pool by priority",
         {solid({box({0, 0, 0}, {0.8, 0.5, 0.6})}, kWater), solid({box({0.2, 0.1, 0}, {0.1, 0.9, 0.1})}, kGlass, 1),
          solid({ball({-0.3, 0, 0}, 0.3)}, kFlint, -1)},
         {-0.6, 0.1, 0.1}});
    all.push_back({"bubbles",
                   {solid({box({0, 0, 0}, {0.8, 0.6, 0.6})}, kGlass), solid({ball({-0.3, 0, 0.1}, 0.25)}, kAir, 1),
                    solid({ball({0.3, 0.1, 0}, 0.35)}, kAir)},
                   {0.0, -0.45, 0.4}});
    std::vector<Shell> many;
    for (int i = 0; i < 12; ++i) {
        const double turn = 0.5235988 * i;
        many.push_back(ball({0.6 * std::cos(turn), 0.6 * std::sin(turn), 0.1 * (i % 3)}, 0.2));
    }
    all.push_back({"a ring of twelve shells", {solid(std::move(many), kGlass)}, {0.6, 0.0, 0.05}});
    return all;
}

View look(glm::dvec3 from, glm::dvec3 at, double fov) {
    View view;
    view.world_from_view = glm::inverse(glm::lookAt(from, at, glm::dvec3(0.05, 1.0, 0.02)));
    view.vertical_fov = fov;
    return view;
}

/// Eyes and solids moved together.
void move(Arrangement& arrangement, const glm::dmat4& world, double scale) {
    for (PlannedSolid& s : arrangement.solids) s.world_from_solid = glm::mat4(world * glm::dmat4(s.world_from_solid));
    const glm::dmat3 turn = glm::dmat3(world) / scale;
    glm::dmat4& eye = arrangement.view.world_from_view;
    const glm::dvec3 position = glm::dvec3(world * eye[3]);
    glm::dmat3 axes = turn * glm::dmat3(eye);
    if (glm::determinant(axes) < 0.0) axes[0] = -axes[0];
    eye = glm::dmat4(glm::dvec4(axes[0], 0.0), glm::dvec4(axes[1], 0.0), glm::dvec4(axes[2], 0.0),
                     glm::dvec4(position, 1.0));
    arrangement.view.vertical_extent *= scale;
}

/// Lengths change, so what is left after a length should not.
void scale_absorption(Arrangement& arrangement, double scale) {
    for (PlannedSolid& s : arrangement.solids) s.medium.sigma_a /= scale;
}

}  // namespace

std::vector<SolidKind> solid_kinds() {
    const glm::dmat4 one(1.0);
    const auto turned = [&](const glm::dvec3& axis, double angle) {
        return glm::rotate(one, angle, glm::normalize(axis));
    };
    const std::vector<std::pair<std::string, std::function<void(Arrangement&, const Kind&)>>> views = {
        {"plain", [](Arrangement&, const Kind&) {}},
        {"rotated",
         [&](Arrangement& a, const Kind&) {
             move(a, turned({1, 2, 0.5}, 0.9), 1.0);
         }},
        {"large",
         [&](Arrangement& a, const Kind&) {
             move(a, glm::scale(one, glm::dvec3(1000.0)), 1000.0), scale_absorption(a, 1000.0);
         }},
        {"small", [&](Arrangement& a,
                      const Kind&) { move(a, glm::scale(one, glm::dvec3(0.001)), 0.001), scale_absorption(a, 0.001); }},
        {"mirrored", [&](Arrangement& a, const Kind&) { move(a, glm::scale(one, glm::dvec3(-1.0, 1.0, 1.0)), 1.0); }},
        {"twice",
         [&](Arrangement& a, const Kind&) {
             const std::size_t count = a.solids.size();
             for (std::size_t i = 0; i < count; ++i) {
                 PlannedSolid copy = a.solids[i];
                 copy.mesh_of = int(i);
                 copy.world_from_solid = glm::mat4(glm::translate(turned({0, 1, 0}, 0.7), glm::dvec3(0.2, 0.15, -2.2)));
                 a.solids.push_back(copy);
             }
         }},
        {"orthographic, straight on",
         [](Arrangement& a, const Kind&) {
             a.view.orthographic = true;
             a.view.vertical_extent = 2.3;
             a.view.world_from_view = glm::dmat4(1.0);
             a.view.world_from_view[3] = glm::dvec4(0.013, 0.021, 5.0, 1.0);
         }},
        {"from inside",
         [](Arrangement& a, const Kind& kind) {
             a.view = look(kind.inside, kind.inside + glm::dvec3(-0.3, 0.1, -1.0), 1.2);
         }},
    };
    std::vector<SolidKind> all;
    for (const Kind& kind : kinds()) {
        for (const auto& [name, change] : views) {
            SolidKind made{kind.name + ", " + name, {}};
            made.arrangement.solids = kind.solids;
            made.arrangement.view = look({0.7, 0.9, 3.6}, {0.0, 0.0, 0.0}, 0.6);
            change(made.arrangement, kind);
            for (PlannedSolid& s : made.arrangement.solids) s.volume = closed_form::material_volume(world_shells(s));
            all.push_back(std::move(made));
        }
    }
    return all;
}

}  // namespace pellucid::test
