#pragma once

#include <pellucid/api.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pellucid {

/// Which Vulkan device to use, and how carefully.
struct DeviceOptions {
    /// Empty: the best usable one (discrete, integrated, virtual, then software). Otherwise an index
    /// of list_devices() or a part of a device name, upper and lower case alike.
    std::string device;
    /// Turns on the Khronos validation layer, core and synchronisation checks. Its messages are
    /// collected (Renderer::validation_messages). DeviceError if the layer is not installed.
    bool validation = false;
    std::uint32_t threads = 0;  ///< of the techniques that trace on the CPU; 0: all cores
};

/// A Vulkan device as the loader reports it.
struct DeviceInfo {
    std::string name;
    std::string driver;                ///< driver name and version
    std::string type;                  ///< discrete, integrated, virtual, software, other
    std::string api_version;           ///< Vulkan version of the device, "1.3.224"
    std::vector<std::string> missing;  ///< what Pellucid needs and the device lacks; empty: usable
    std::vector<std::string> absent;   ///< optional features it lacks, with what happens instead
};

/// Every Vulkan device on this machine, usable or not. Throws DeviceError if Vulkan itself fails.
PELLUCID_API std::vector<DeviceInfo> list_devices();

/// Time that one group of passes took on the device.
struct PassTime {
    std::string name;
    double time_ms;
};

}  // namespace pellucid
