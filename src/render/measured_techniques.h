#pragma once

// Frame times of techniques on a device, measured once and stored, to choose the fastest for presets.
#include <pellucid/device.h>

#include <span>
#include <string_view>
#include <vector>

namespace pellucid {

/// Milliseconds per frame of techniques that the device supports: the least of five, for a glass knot at 256x256
/// pixels. They are measured on first use on this device and driver by this version, which takes a second or two.
/// Times are then kept in memory and, if writable, in `presets.json` of the cache folder
/// (bake::default_cache_folder()), which may be deleted at any time.
std::vector<double> measured_times(const DeviceInfo& device, const DeviceOptions& options,
                                   std::span<const std::string_view> techniques);

}  // namespace pellucid
