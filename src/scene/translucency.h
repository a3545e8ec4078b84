#pragma once

#include <pellucid/scene.h>

namespace pellucid {

/// Throws Error for values out of range.
void check_translucency(const Translucency& translucency);

}  // namespace pellucid
