#include "scene/volumes/volume_source.h"

#include "core/fail.h"

#include <pellucid/file.h>

namespace pellucid {

bool names_volume(const std::string& source) {
    return source.starts_with(kVolumePrefix) || lower_extension(source) == ".vdb";
}

Volume open_volume(const std::string& source, const FileScope& scope, std::span<const GridMapping> mapping) {
    const bool made = source.starts_with(kVolumePrefix);
    if (!made && lower_extension(source) == ".vdb") {
        scope.check(scope.folder / source);
        return load_volume(scope.folder / source, mapping);
    }
    if (!mapping.empty()) fail(source, "has no grids; those of .vdb files are mapped to fields");
    if (!made) fail(source, "is no volume: neither volume:NAME nor a .vdb file");
    return make_volume(source.substr(kVolumePrefix.size()));
}

}  // namespace pellucid
