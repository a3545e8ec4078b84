#pragma once

// tinygltf, compiled into this module (tinygltf.cpp) under its own namespace. Debian's libdraco, a dependency of
// assimp, exports another version of tinygltf with the same symbols. The library loaded first would serve both, and
// crash.
#define tinygltf pellucid_tinygltf
#define TINYGLTF_NO_STB_IMAGE  // core/image decodes images
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>
