#include "commands.h"

#include <pellucid/pellucid.h>

#include <fmt/format.h>

namespace pellucid::cli {

void add_info_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("info", "Print the Vulkan devices found and what they lack");
    command->callback([] {
        fmt::print("pellucid {}\n", version());
        const std::vector<DeviceInfo> devices = list_devices();
        bool usable = false;
        for (std::size_t i = 0; i < devices.size(); ++i) {
            const DeviceInfo& device = devices[i];
            fmt::print("{}: {} ({}, Vulkan {}{}{})\n", i, device.name, device.type, device.api_version,
                       device.driver.empty() ? "" : ", ", device.driver);
            for (const std::string& missing : device.missing) fmt::print("   not usable: lacks {}\n", missing);
            for (const std::string& absent : device.absent) fmt::print("   without {}\n", absent);
            usable = usable || device.missing.empty();
        }
        if (!usable) throw DeviceError("no usable Vulkan device; a software one comes with Mesa's Vulkan drivers");
        // The device itself is made as well: a driver may list a device that it then cannot open.
        fmt::print("default: {}\n", Renderer().device().name);
    });
}

}  // namespace pellucid::cli
