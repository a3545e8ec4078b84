#pragma once

#include <pellucid/pellucid.h>

namespace pellucid::cli {

/// Scenes of several solids of glass that stand behind one another in the first view of comparison_view().
Scene cube_before_knot();
Scene sphere_before_sphere();
Scene five_objects();

/// `environment` as an equirectangular map of `width` x `width / 2` texels, each the mean over its area.
Environment resampled(const Environment& environment, int width);

}  // namespace pellucid::cli
