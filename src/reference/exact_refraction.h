#pragma once

#include "reference/curved_volumes.h"
#include "reference/geometry.h"

#include <pellucid/path_surfaces.h>
#include <pellucid/reference.h>

#include <cstdint>
#include <vector>

namespace pellucid::reference {

/// Throws Error for settings out of range.
void check_exact_settings(const ExactSettings& settings);

/// Implementation of Tracer::exact. One path per pixel: refracted at every interface, or reflected at total internal
/// reflection. It ends in the environment, on an opaque surface, or at an interface beyond max_events.
///
/// - An interface (event) separates the media of two solids, or a solid and air, even if their indices are equal: the
///   angle of refraction then equals the angle of incidence. A boundary inside a solid that displaces its solid is no
///   interface.
/// - The interpolated normal bends the path. The triangle tells whether the path is then on the far side. Where
///   the two normals differ, a total reflection can therefore end up outside.
/// - A path that starts in glass begins in its medium. A path in a closed solid that finds no further surface has
///   Status::kMissingLayer: a flaw of the search or of the mesh.
/// - Thin-walled surfaces do not bend light; their tint is not part of `transmittance`.
/// - Indices of refraction are those of settings.channel, and so is the Fresnel part of `transmittance`.
/// - Without any interface, `position` is the eye (orthographic: its point in the camera's plane) and `length` is 0.
/// - Outside all solids a path bends in volumes (curved_volumes.h). A path through volumes without an interface has
///   one event; its `position` is the exit from the last volume. A trapped path has Status::kStepLimit.
/// Throws Error for settings or a camera out of range. `threads` 0: all cores.
std::vector<RefractedPath> trace_exact(const Geometry& geometry, const CurvedVolumes& volumes, const Camera& camera,
                                       const ExactSettings& settings, std::uint32_t threads, const Progress& progress);

/// Implementation of SurfaceTracer::trace: the same paths, with their surfaces.
std::vector<SurfacePath> trace_surfaces(const Geometry& geometry, const CurvedVolumes& volumes, const Camera& camera,
                                        const ExactSettings& settings, std::uint32_t threads, const Progress& progress);

}  // namespace pellucid::reference
