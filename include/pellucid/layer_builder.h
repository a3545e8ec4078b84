#pragma once

#include <pellucid/api.h>

#include <string_view>

namespace pellucid {

/// How layers are gathered. All give the same layers; kCompute but for pixels whose centres lie on an edge to within
/// rounding.
enum class LayerBuilder {
    kAutomatic,         ///< kCompute on devices that are CPUs, kSinglePass on others (default)
    kSinglePass,        ///< per-pixel lists, one geometry pass
    kDepthPeeling,      ///< one geometry pass per layer (Everitt 2001)
    kCompute,           ///< per-pixel lists, triangles rasterised in compute shaders; visibility techniques use it
    kDualDepthPeeling,  ///< nearest and farthest in one geometry pass, half as many (Bavoil & Myers 2008)
};

/// The builder of a name: automatic, single-pass, compute, depth-peeling, dual-depth-peeling. Throws Error listing them.
PELLUCID_API LayerBuilder parse_layer_builder(std::string_view name);

}  // namespace pellucid
