#pragma once

#include "reference/curved_volumes.h"
#include "reference/geometry.h"

#include <pellucid/reference.h>

#include <cstdint>
#include <vector>

namespace pellucid::reference {

/// Throws Error for settings out of range.
void check_exact_settings(const ExactSettings& settings);

/// Tracer::exact. One path per pixel: refracted at every interface, reflected where it is totally
/// reflected; it ends in the environment, on an opaque surface, or at an interface beyond max_events.
///
/// - Interfaces, and so events, are where one solid's medium ends and another's (or air) begins, also
///   if their indices of refraction are equal: such an interface has an angle of refraction, it just
///   is the angle of incidence. A boundary inside a solid that displaces it is none.
/// - The interpolated normal bends the path; whether the path then is on the far side follows from the
///   triangle it met. Where the two normals differ, a total reflection can so end up outside.
/// - A path that starts in glass begins in its medium. One that is in a closed solid and finds no
///   surface any more has Status::kMissingLayer: a flaw of the search or of the mesh.
/// - Thin-walled surfaces do not bend light; their tint is not part of `transmittance`.
/// - Indices of refraction, and the Fresnel share of all of `transmittance`, are those of settings.channel.
/// - Without any interface `position` is the eye (orthographic: its point in the camera's plane) and
///   `length` 0.
/// - Around all solids a path bends in volumes (curved_volumes.h). One that has crossed some, but no interface, has one
///   event; its `position` is where it left the last volume. One that a volume has caught has Status::kStepLimit.
/// Throws Error for settings or a camera out of range. `threads` 0: all cores.
std::vector<RefractedPath> trace_exact(const Geometry& geometry, const CurvedVolumes& volumes, const Camera& camera,
                                       const ExactSettings& settings, std::uint32_t threads, const Progress& progress);

}  // namespace pellucid::reference
