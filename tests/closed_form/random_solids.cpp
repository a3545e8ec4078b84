#include "closed_form/random_solids.h"

#include <algorithm>
#include <cmath>

namespace pellucid::test {

using closed_form::Shell;
using closed_form::ShellKind;

namespace {

constexpr double kTurn = 6.283185307179586;

glm::dmat4 frame(const glm::dvec3& center, const glm::dmat3& linear) {
    glm::dmat4 m(linear);
    m[3] = glm::dvec4(center, 1.0);
    return m;
}

glm::dmat3 scaling(const glm::dvec3& s) { return {s.x, 0, 0, 0, s.y, 0, 0, 0, s.z}; }

/// Points spread over a shell, moved out by `margin` m.
std::vector<glm::dvec3> surface_points(const Shell& shell, double margin) {
    std::vector<glm::dvec3> points;
    constexpr int kCount = 600;
    for (int i = 0; i < kCount; ++i) {
        const double z = 1.0 - 2.0 * (i + 0.5) / kCount, phi = i * kTurn * 0.6180339887498949;
        glm::dvec3 p(std::sqrt(1.0 - z * z) * std::cos(phi), std::sqrt(1.0 - z * z) * std::sin(phi), z);
        if (shell.kind == ShellKind::kBox) p /= std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        const glm::dvec3 along = glm::dmat3(shell.world_from_shell) * p;
        points.push_back(glm::dvec3(shell.world_from_shell[3]) + along + margin * glm::normalize(along));
    }
    if (shell.kind == ShellKind::kBox)
        for (int k = 0; k < 8; ++k) {
            const glm::dvec3 corner(k % 2 * 2 - 1, k / 2 % 2 * 2 - 1, k / 4 * 2 - 1);
            const glm::dvec3 along = glm::dmat3(shell.world_from_shell) * corner;
            points.push_back(glm::dvec3(shell.world_from_shell[3]) + along + margin * glm::normalize(along));
        }
    return points;
}

}  // namespace

std::uint64_t Random::next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15ull;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
}

double Random::between(double low, double high) { return low + (high - low) * double(next() >> 11) * 0x1p-53; }

std::uint32_t Random::below(std::uint32_t count) { return std::uint32_t(next() % count); }

glm::dvec3 Random::direction() {
    const double z = between(-1.0, 1.0), phi = between(0.0, kTurn), r = std::sqrt(1.0 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

glm::dvec3 Random::in_ball() {
    const glm::dvec3 d = direction();
    return d * std::cbrt(between(0.0, 1.0));
}

/// Shoemake 1992, Uniform random rotations.
glm::dmat3 Random::turn() {
    const double u = between(0.0, 1.0), a = between(0.0, kTurn), b = between(0.0, kTurn);
    const double r = std::sqrt(1.0 - u), s = std::sqrt(u);
    return glm::dmat3(glm::mat3_cast(glm::dquat(s * std::cos(b), r * std::sin(a), r * std::cos(a), s * std::sin(b))));
}

glm::dmat3 Random::quarter_turns() {
    const std::uint32_t axis = below(3);
    glm::dmat3 m(0.0);
    for (std::uint32_t k = 0; k < 3; ++k) m[int(k)][int((k + axis) % 3)] = chance(0.5) ? 1.0 : -1.0;
    if (glm::determinant(m) < 0.0) m[0] = -m[0];
    return m;
}

std::vector<Shell> world_shells(const PlannedSolid& solid) {
    std::vector<Shell> shells;
    for (const PlannedShell& planned : solid.shells) {
        shells.push_back(planned.shell);
        shells.back().world_from_shell = glm::dmat4(solid.world_from_solid) * planned.shell.world_from_shell;
    }
    return shells;
}

bool cavities_are_clear(const std::vector<Shell>& shells) {
    constexpr double kMargin = 0.02;
    for (std::size_t i = 0; i < shells.size(); ++i) {
        if (shells[i].winding > 0) continue;
        if (!inside_others(shells, i)) return false;
        for (std::size_t j = 0; j < shells.size(); ++j) {
            if (i == j) continue;
            int inside = 0, all = 0;
            for (const double margin : {-kMargin, kMargin})
                for (const glm::dvec3& p : surface_points(shells[i], margin)) {
                    ++all;
                    inside += closed_form::contains(shells[j], p) ? 1 : 0;
                }
            // A shell wholly within the cavity contains no point of its wall.
            if (inside != 0 && inside != all) return false;
        }
    }
    return true;
}

bool inside_others(const std::vector<Shell>& shells, std::size_t shell) {
    for (const glm::dvec3& p : surface_points(shells[shell], 0.01)) {
        int winding = 0;
        for (std::size_t j = 0; j < shells.size(); ++j)
            if (j != shell && closed_form::contains(shells[j], p)) winding += shells[j].winding;
        if (winding < 1) return false;
    }
    return true;
}

/// A ball, an ellipsoid or a box of about `size` m from centre to surface.
Shell SolidChooser::shell(const glm::dvec3& center, double size) {
    Shell result;
    result.kind = random_.chance(0.5) ? ShellKind::kBall : ShellKind::kBox;
    const bool ball = result.kind == ShellKind::kBall;
    glm::dvec3 half(size);
    if (ball ? random_.chance(0.25) : random_.chance(0.7))
        for (int axis = 0; axis < 3; ++axis) half[axis] *= random_.between(ball ? 0.6 : 0.35, 1.2);
    glm::dmat3 turn = random_.turn();
    glm::dvec3 at = center;
    if (tidy_) {
        turn = random_.quarter_turns();
        half = glm::max(glm::round(half * 8.0), 1.0) / 8.0;
        at = glm::round(at * 4.0) / 4.0;
    }
    result.world_from_shell = frame(at, turn * scaling(half));
    return result;
}

Shell SolidChooser::fresh() { return shell(0.9 * random_.in_ball(), random_.between(0.2, 0.7)); }

const PlannedSolid* SolidChooser::any_so_far() {
    return so_far_.empty() ? nullptr : &so_far_[random_.below(std::uint32_t(so_far_.size()))];
}

/// Shells of one body: apart, overlapping, one in the other, one twice, two cubes face to face.
SolidChooser::Shells SolidChooser::several(std::string& story) {
    const Shell first = fresh();
    const glm::dvec3 center(first.world_from_shell[3]);
    switch (random_.below(5)) {
        case 0: {
            story = "shells that overlap";
            Shells shells{first};
            const std::uint32_t more = 1 + random_.below(3);
            for (std::uint32_t k = 0; k < more; ++k)
                shells.push_back(shell(center + 0.4 * random_.in_ball(), random_.between(0.15, 0.5)));
            return shells;
        }
        case 1: {
            story = "shells anywhere";
            Shells shells{first};
            const std::uint32_t more = 1 + random_.below(3);
            for (std::uint32_t k = 0; k < more; ++k) shells.push_back(fresh());
            return shells;
        }
        case 2:
            story = "a shell in a shell";
            return {first, shell(center, random_.between(0.05, 0.1))};
        case 3: {
            story = "cubes face to face";
            Shell a = first;
            a.kind = ShellKind::kBox;
            Shell b = a;
            b.world_from_shell[3] += 2.0 * a.world_from_shell[random_.below(3)];
            return {a, b};
        }
        default:
            return with_cavity(story);
    }
}

/// A hollow shell, and at times an island in the hollow.
SolidChooser::Shells SolidChooser::with_cavity(std::string& story) {
    story = "a hollow";
    const Shell outer = shell(0.5 * random_.in_ball(), random_.between(0.5, 0.8));
    const glm::dvec3 center(outer.world_from_shell[3]);
    Shell inner = shell(center + 0.1 * random_.in_ball(), random_.between(0.15, 0.35));
    if (random_.chance(0.3)) {
        inner = outer;
        for (int axis = 0; axis < 3; ++axis) inner.world_from_shell[axis] *= 0.7;
    }
    inner.winding = -1;
    Shells shells{outer, inner};
    if (random_.chance(0.3)) {
        story += " with an island";
        shells.push_back(shell(glm::dvec3(inner.world_from_shell[3]), random_.between(0.05, 0.1)));
    }
    return shells;
}

/// A box whose face lies on a face of another's.
SolidChooser::Shells SolidChooser::touching(const PlannedSolid& other, std::string& story) {
    story = "a box that touches a box";
    Shell box = world_shells(other).front();
    const int axis = int(random_.below(3));
    const bool equal = random_.chance(0.3);
    const double side = random_.chance(0.5) ? 1.0 : -1.0, size = equal ? 1.0 : random_.between(0.4, 1.6);
    glm::dvec4 shift = box.world_from_shell[axis] * (side * (1.0 + size));
    for (int k = 0; k < 3; ++k) {
        if (k != axis && !equal) {
            shift += box.world_from_shell[k] * random_.between(-0.6, 0.6);
            box.world_from_shell[k] *= random_.between(0.4, 1.6);
        }
    }
    box.world_from_shell[axis] *= size;
    box.world_from_shell[3] += shift;
    return {box};
}

/// Shells that stand in a relation to a solid so far.
std::optional<SolidChooser::Shells> SolidChooser::related(std::string& story) {
    const PlannedSolid* const other = any_so_far();
    if (!other) return std::nullopt;
    const Shells shells = world_shells(*other);
    const Shell& first = shells.front();
    const glm::dvec3 center(first.world_from_shell[3]);
    const double size = std::cbrt(std::abs(glm::determinant(glm::dmat3(first.world_from_shell))));
    // Few solids are hollow, so these are filled often.
    if (shells.size() == 2 && shells[1].winding < 0 && random_.chance(0.7)) {
        story = "fills a hollow";
        return Shells{{shells[1].kind, shells[1].world_from_shell, 1}};
    }
    switch (random_.below(5)) {
        case 0:
            story = "in another";
            return Shells{shell(center + 0.2 * size * random_.in_ball(), 0.4 * size)};
        case 1:
            story = "around another";
            return Shells{shell(center, std::min(1.8 * size, 1.2))};
        case 2:
            story = other->story + ", another at the same place";
            return shells;
        default:
            if (shells.size() != 1 || first.kind != ShellKind::kBox) return std::nullopt;
            return touching(*other, story);
    }
}

/// Turned, stretched, mirrored, or none of it: the shells are where they are all the same.
glm::mat4 SolidChooser::node_matrix() {
    if (random_.chance(0.25)) return glm::mat4(1.0f);
    glm::dvec3 scale(std::exp2(random_.between(-2.0, 2.0)));
    if (random_.chance(0.3)) scale *= glm::dvec3(random_.between(0.5, 2.0), random_.between(0.5, 2.0), 1.0);
    if (random_.chance(0.3)) scale.x = -scale.x;
    const glm::dmat3 turn = tidy_ ? random_.quarter_turns() : random_.turn();
    if (tidy_) scale = glm::exp2(glm::round(glm::log2(glm::abs(scale)))) * glm::sign(scale);
    return glm::mat4(frame(tidy_ ? glm::dvec3(0.25) : random_.in_ball(), turn * scaling(scale)));
}

closed_form::Medium SolidChooser::medium() {
    const PlannedSolid* const other = any_so_far();
    if (other && random_.chance(0.15)) return other->medium;
    closed_form::Medium medium;
    const bool bubble = !single_ && random_.chance(0.05);
    const auto too_near = [&](const PlannedSolid& s) { return std::abs(s.medium.ior - medium.ior) < 0.03; };
    do medium.ior = bubble ? 1.0 : std::round(random_.between(1.1, 2.2) * 1000.0) / 1000.0;
    while (!bubble && std::any_of(so_far_.begin(), so_far_.end(), too_near));
    if (!bubble && random_.chance(0.6))
        medium.sigma_a = {random_.between(0, 1.2), random_.between(0, 1.2), random_.between(0, 1.2)};
    return medium;
}

std::optional<PlannedSolid> SolidChooser::instance() {
    const PlannedSolid* const other = any_so_far();
    if (!other || other->mesh_of >= 0) return std::nullopt;
    PlannedSolid solid = *other;
    solid.mesh_of = int(other - so_far_.data());
    solid.story = "the same mesh elsewhere";
    const double scale = random_.chance(0.4) ? 1.0 : random_.between(0.4, 0.9);
    glm::dmat3 linear = (tidy_ ? random_.quarter_turns() : random_.turn()) * scaling(glm::dvec3(scale));
    if (random_.chance(0.4)) linear[0] = -linear[0];
    const glm::dmat4 from(glm::dmat4(other->world_from_solid));
    // Turned about its own centre, then moved.
    const glm::dvec3 center(world_shells(*other).front().world_from_shell[3]), there = 0.8 * random_.in_ball();
    solid.world_from_solid = glm::mat4(frame(there, linear) * frame(-center, glm::dmat3(1.0)) * from);
    solid.volume = other->volume * scale * scale * scale;
    solid.priority = random_.chance(0.3) ? int(random_.below(5)) - 2 : 0;
    return solid;
}

/// Ways of writing one solid that mean the same.
void SolidChooser::write_oddly(PlannedSolid& solid) {
    const Shells shells = world_shells(solid);
    const bool hollow = std::any_of(shells.begin(), shells.end(), [](const Shell& s) { return s.winding < 0; });
    if (random_.chance(0.3)) solid.primitives = 2 + int(random_.below(2));
    // Cubes that share a wall are one surface of the file: which way it should be turned is not for this test to say.
    const bool walled = solid.story.find("face to face") != std::string::npos || (tidy_ && shells.size() > 1);
    if (!hollow && !walled && random_.chance(0.08)) {
        solid.double_sided = true;
    } else if (shells.size() == 1 && random_.chance(0.12)) {
        solid.miswound = true;
    } else if (!hollow && !walled && random_.chance(0.25)) {
        const std::size_t k = random_.below(std::uint32_t(shells.size()));
        if (!inside_others(shells, k)) solid.shells[k].written_inside_out = true;
    }
    if (!solid.double_sided && random_.chance(0.1)) solid.shells.back().written_twice = true;
}

std::optional<PlannedSolid> SolidChooser::choose() {
    const double dice = random_.between(0.0, 1.0);
    if (!single_ && dice < 0.1) return instance();
    PlannedSolid solid;
    std::optional<Shells> shells;
    if (single_ || dice < 0.35) {
        solid.story = "by itself";
        shells = Shells{fresh()};
    } else if (dice < 0.65) {
        shells = several(solid.story);
    } else {
        shells = related(solid.story);
    }
    if (!shells || !cavities_are_clear(*shells)) return std::nullopt;
    solid.world_from_solid = node_matrix();
    const glm::dmat4 solid_from_world = glm::inverse(glm::dmat4(solid.world_from_solid));
    for (const Shell& s : *shells) solid.shells.push_back({{s.kind, solid_from_world * s.world_from_shell, s.winding}});
    solid.volume = closed_form::material_volume(*shells);
    solid.medium = medium();
    solid.priority = !single_ && random_.chance(0.35) ? int(random_.below(5)) - 2 : 0;
    write_oddly(solid);
    return solid;
}

}  // namespace pellucid::test
