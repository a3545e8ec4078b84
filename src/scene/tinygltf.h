#pragma once

// tinygltf, compiled into this room (tinygltf.cpp) under a namespace of its own. Debian's libdraco,
// which assimp brings along, exports a tinygltf of another version with the same symbols; whichever
// library is loaded first would answer for both, and crash.
#define tinygltf pellucid_tinygltf
#define TINYGLTF_NO_STB_IMAGE  // images are decoded by core/image
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>
