#pragma once

// Options about volumes in scenes.

#include <pellucid/pellucid.h>

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace pellucid::cli {

/// What the command line says about volumes. Strings are parsed when the command runs, so that errors are ours.
struct VolumeArguments {
    std::vector<std::string> grids;
    std::vector<std::string> added;
};
void add_volume_options(CLI::App& command, VolumeArguments& arguments);

/// `options` with the mappings of --map, which are for every .vdb file among `source` and the volumes to be added.
LoadOptions with_grids(LoadOptions options, const std::string& source, const VolumeArguments& arguments);

/// Adds the volumes of --add-volume to a scene. Throws Error naming what is wrong with one of them.
void add_volumes(Scene& scene, const VolumeArguments& arguments);

}  // namespace pellucid::cli
