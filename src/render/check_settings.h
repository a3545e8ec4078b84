#pragma once

#include "gpu/device.h"

#include <pellucid/renderer.h>

namespace pellucid {

/// Throws Error if a setting is out of range, or if the image does not fit this machine's memory.
void check_settings(const RenderSettings& settings, const Device& device);

}  // namespace pellucid
