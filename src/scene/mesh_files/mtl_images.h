#pragma once

#include <pellucid/image.h>

namespace pellucid {

/// RGBA of the larger size of both: colours of the one (white without any), alpha of the other: its alpha channel, or else
/// the mean of its colours.
Image with_alpha(const Image& color, const Image& alpha);

/// RGB of the larger size of both, either of which may be empty: green is the first value of `roughness`, blue that of
/// `metal`, as in a metallic-roughness texture of glTF. An empty one gives 1.
Image roughness_and_metal(const Image& roughness, const Image& metal);

/// Normals (RGB, -1..1 as 0..1, green along -v) of a bump map. A grey one has heights, of which white lies `scale` texels
/// above black; a coloured one has normals, whose slopes `scale` multiplies. Ends repeat, or are `clamped`.
Image normals_from_bump(const Image& bump, float scale, bool clamped);

}  // namespace pellucid
