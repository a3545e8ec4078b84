#pragma once

#include "lab/experiments.h"

namespace pellucid::cli {

/// Chen, table 1: three balls lit along their axis, compared with a ray march of their signed distance field.
ExperimentSpec chen_error();
/// Chen, table 2: a dragon of 514,372 triangles, single against dual depth peeling.
ExperimentSpec chen_speed();

/// Splits the longest edges of the triangles consistently, until there are about `count` triangles or every edge was
/// split once. The surface does not change.
Mesh with_split_edges(const Mesh& mesh, std::size_t count);

}  // namespace pellucid::cli
