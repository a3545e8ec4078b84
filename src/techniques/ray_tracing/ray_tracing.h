#pragma once

#include "techniques/technique.h"

namespace pellucid {

/// Every interface by tracing rays against the triangles, on devices with ray-tracing pipelines.
extern const Technique kRayTracing;

}  // namespace pellucid
