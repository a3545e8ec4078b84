#pragma once

// What random arrangements are made of.
#include "closed_form/arrangement.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace pellucid::test {

/// SplitMix64 (Steele, Lea & Flood 2014): the same numbers on every machine, unlike distributions of the standard library.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) { state_ = next(); }  // else streams of seeds overlap
    std::uint64_t next();
    double between(double low, double high);  ///< uniform
    std::uint32_t below(std::uint32_t count);
    bool chance(double probability) { return between(0.0, 1.0) < probability; }
    glm::dvec3 in_ball();    ///< of radius 1, uniform
    glm::dvec3 direction();  ///< unit, uniform
    glm::dmat3 turn();       ///< uniform over all rotations
    glm::dmat3 quarter_turns();

private:
    std::uint64_t state_;
};

/// Plans one more solid for an arrangement. Nothing comes of a choice that the solids so far do not allow.
class SolidChooser {
public:
    /// `tidy`: all lies along the axes, on a grid. `single`: one shell.
    SolidChooser(Random& random, const std::vector<PlannedSolid>& so_far, bool tidy, bool single)
        : random_(random), so_far_(so_far), tidy_(tidy), single_(single) {}
    std::optional<PlannedSolid> choose();

private:
    using Shells = std::vector<closed_form::Shell>;  // in the world

    closed_form::Shell shell(const glm::dvec3& center, double size);
    closed_form::Shell fresh();
    Shells several(std::string& story);
    Shells with_cavity(std::string& story);
    Shells touching(const PlannedSolid& other, std::string& story);
    std::optional<Shells> related(std::string& story);
    std::optional<PlannedSolid> instance();
    void write_oddly(PlannedSolid& solid);
    glm::mat4 node_matrix();
    closed_form::Medium medium();
    const PlannedSolid* any_so_far();

    Random& random_;
    const std::vector<PlannedSolid>& so_far_;
    bool tidy_;
    bool single_;
};

/// A solid's shells in the world.
std::vector<closed_form::Shell> world_shells(const PlannedSolid& solid);
/// True if every cavity lies inside other shells, with a margin, and crosses none.
bool cavities_are_clear(const std::vector<closed_form::Shell>& shells);
/// True if the shell lies inside the union of the other shells.
bool inside_others(const std::vector<closed_form::Shell>& shells, std::size_t shell);

}  // namespace pellucid::test
