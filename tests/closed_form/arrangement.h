#pragma once

// Random arrangements of balls and boxes: overlapping, nested, duplicated, touching, inside out, joined to surfaces that
// cross themselves, split over primitives, mirrored, instanced. Each is both a closed-form scene and a GLB file that asks for the loader's repair.
#include "closed_form/closed_form_scene.h"
#include "closed_form/solid_file.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace pellucid::test {

/// A shell of a solid, in the solid's own frame. Its winding is what it means; the file may have it otherwise.
struct PlannedShell {
    closed_form::Shell shell;
    bool written_inside_out = false;
    bool written_twice = false;
};

/// One node of the file, one body.
struct PlannedSolid {
    std::string story;
    std::vector<PlannedShell> shells;
    int mesh_of = -1;  ///< an earlier solid whose mesh, and so material, the node shares; -1: a mesh of its own
    glm::mat4 world_from_solid{1.0f};
    closed_form::Medium medium;
    int priority = 0;
    double volume = 0.0;  ///< m3, of material, in the world
    int primitives = 1;
    bool double_sided = false;  ///< every triangle is written twice, wound either way
    bool miswound = false;      ///< a third of the faces are wound the other way
    bool bridged = false;       ///< its first two shells are one surface, which crosses itself
};

struct Arrangement {
    std::uint32_t seed = 0;
    std::vector<PlannedSolid> solids;
    closed_form::View view;
};

/// The same for the same seed on every machine. Every fifth has one solid, with one shell.
Arrangement make_arrangement(std::uint32_t seed);

closed_form::Scene closed_form_scene(const Arrangement& arrangement);
/// The arrangement as a GLB file.
SolidFile solid_file(const Arrangement& arrangement, int ball_levels = 5);
/// The same arrangement with nothing for the loader to repair: one primitive a solid, every triangle once and outward.
Arrangement written_plainly(Arrangement arrangement);
/// Several lines: view, solids, shells.
std::string describe(const Arrangement& arrangement);

}  // namespace pellucid::test
