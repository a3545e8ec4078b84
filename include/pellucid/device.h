#pragma once

#include <pellucid/api.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pellucid {

/// Choice of the Vulkan device, and validation.
struct DeviceOptions {
    /// Empty: the best usable device (discrete, integrated, virtual, then software). Otherwise an index into
    /// list_devices() or a part of a device name, in upper or lower case.
    std::string device;
    /// Turns on the Khronos validation layer with core and synchronisation checks. Renderer::validation_messages()
    /// returns its messages. DeviceError if the layer is not installed.
    bool validation = false;
    std::uint32_t threads = 0;  ///< threads of techniques that trace on the CPU; 0: all cores
};

/// A Vulkan device as the loader reports it.
struct DeviceInfo {
    std::string name;
    std::string driver;                ///< driver name and version
    std::string type;                  ///< discrete, integrated, virtual, software, other
    std::string api_version;           ///< Vulkan version of the device, "1.3.224"
    std::vector<std::string> missing;  ///< required features that the device lacks; empty: usable
    std::vector<std::string> absent;   ///< optional features that the device lacks, each with the fallback used
};

/// Every Vulkan device on this machine, usable or not. Throws DeviceError if Vulkan itself fails.
PELLUCID_API std::vector<DeviceInfo> list_devices();

/// Time that one group of passes took on the device.
struct PassTime {
    std::string name;
    double time_ms;
};

}  // namespace pellucid
