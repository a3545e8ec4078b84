#pragma once

#include "core/file_scope.h"

#include <pellucid/volume.h>

#include <span>
#include <string>
#include <string_view>

namespace pellucid {

inline constexpr std::string_view kVolumePrefix = "volume:";

/// True for sources that open_volume() accepts.
bool names_volume(const std::string& source);

/// Opens a volume by its name in scenes: `volume:NAME[,PARAMETER=VALUE...]`, see make_volume(), or an OpenVDB file that
/// `scope` allows, relative to its folder, see load_volume(). Throws Error as these functions do.
Volume open_volume(const std::string& source, const FileScope& scope, std::span<const GridMapping> mapping = {});

}  // namespace pellucid
