#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_query : require
#define PELLUCID_RAY_QUERY
#include "techniques/visibility_layers/follow_paths.glsl"
