#pragma once

// Small scenes, one for each way in which solids meet, each seen in several ways.
#include "closed_form/arrangement.h"

#include <string>
#include <vector>

namespace pellucid::test {

struct SolidKind {
    std::string name;  ///< kind and view
    Arrangement arrangement;
};

/// Ten kinds: overlapping, crossing itself, touching, nested, hollow, duplicated, inside out, by priority, air in glass, many shells;
/// and of each eight views: plain, rotated, large, small, mirrored, twice in the scene, orthographic straight on, and with
/// the eye inside.
std::vector<SolidKind> solid_kinds();

}  // namespace pellucid::test
