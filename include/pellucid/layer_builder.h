#pragma once

#include <pellucid/api.h>

#include <string_view>

namespace pellucid {

/// Method of building layers. All methods give the same layers, except that kCompute may differ at pixels whose
/// centres lie on an edge to within rounding.
enum class LayerBuilder {
    kAutomatic,         ///< kCompute on devices that are CPUs, kSinglePass on others (default)
    kSinglePass,        ///< per-pixel lists, one geometry pass
    kDepthPeeling,      ///< one geometry pass per layer (Everitt 2001)
    kCompute,           ///< per-pixel lists, triangles rasterised in compute shaders; for visibility techniques
    kDualDepthPeeling,  ///< nearest and farthest layer per geometry pass, half as many passes (Bavoil & Myers 2008)
};

/// The builder with this name: automatic, single-pass, compute, depth-peeling, dual-depth-peeling. Throws Error
/// listing the names.
PELLUCID_API LayerBuilder parse_layer_builder(std::string_view name);

}  // namespace pellucid
