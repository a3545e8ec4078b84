#pragma once

#include "scene/warnings.h"

#include <pellucid/scene.h>

namespace pellucid {

/// Warns once for each material of glass whose attenuation distance and whose objects differ in size by more than
/// 1,000 times: the file is then often in another unit than metres.
void hint_at_units(const Scene& scene, Warnings& warnings);

}  // namespace pellucid
