#pragma once

// Options for volumes in scenes.

#include <pellucid/pellucid.h>

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace pellucid::cli {

/// Command line arguments for volumes. They are parsed when the command runs, so that this program reports the errors.
struct VolumeArguments {
    std::vector<std::string> grids;
    std::vector<std::string> added;
};
void add_volume_options(CLI::App& command, VolumeArguments& arguments);

/// `options` with the mappings of --map, which apply to every .vdb file among `source` and the added volumes.
LoadOptions with_grids(LoadOptions options, const std::string& source, const VolumeArguments& arguments);

/// Adds the volumes of --add-volume to a scene. Throws Error naming the invalid volume and the cause.
void add_volumes(Scene& scene, const VolumeArguments& arguments);

}  // namespace pellucid::cli
