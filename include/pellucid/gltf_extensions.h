#pragma once

#include <pellucid/api.h>

#include <cstdint>
#include <span>
#include <string_view>

namespace pellucid {

/// What load_scene() does with a glTF extension.
enum class GltfSupport : std::uint8_t {
    kDrawn,         ///< as its specification says
    kApproximated,  ///< drawn, but for what a warning names where a file has it
    kNoEffect,      ///< changes nothing in an image
    kIgnored,       ///< left out with a warning, also where a file requires it
    kRefused,       ///< left out with a warning; a file that requires it throws Error
};

struct GltfExtension {
    std::string_view name;
    GltfSupport support;
    std::string_view how;  ///< what is drawn, approximated or left out
};

/// Every extension that the loader knows, by name. Any other one is treated as kRefused.
PELLUCID_API std::span<const GltfExtension> gltf_extensions();

/// "drawn", "approximated", "no effect", "ignored" or "refused".
PELLUCID_API std::string_view support_name(GltfSupport support);

}  // namespace pellucid
