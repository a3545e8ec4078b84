#pragma once

// Which of several techniques that draw the same picture is the fastest on a device: measured once, and kept.
#include <pellucid/device.h>

#include <span>
#include <string_view>
#include <vector>

namespace pellucid {

/// Milliseconds per frame of techniques that the device has, the least of five, on a knot of glass of 256x256 pixels. They
/// are drawn in turn the first time that they are asked for on this device and driver by this version, a second or two; then
/// times are kept in memory and, if it can be written, in `presets.json` of the cache folder
/// (bake::default_cache_folder()), which may be removed at any time.
std::vector<double> measured_times(const DeviceInfo& device, const DeviceOptions& options,
                                   std::span<const std::string_view> techniques);

}  // namespace pellucid
