#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#define PELLUCID_HELD_VOLUMES
#include "techniques/visibility_layers/follow_paths.glsl"
