#pragma once

#include <pellucid/pellucid.h>

namespace pellucid::cli {

/// Scenes of several glass solids behind one another in the first view of comparison_view().
Scene cube_before_knot();
Scene sphere_before_sphere();
Scene five_objects();

/// Closes every hole of the scene's meshes by a fan of flat triangles about the middle of its rim. Replaces the warnings
/// of the scene by one that says so.
void close_holes(Scene& scene);

/// `environment` as an equirectangular map of `width` x `width / 2` texels, each the mean over several directions in
/// it.
Environment resampled(const Environment& environment, int width);

}  // namespace pellucid::cli
