#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/ray_tracing/surface_hit.glsl"

layout(location = 0) rayPayloadInEXT SurfaceHit hit;

void main() { hit.object = kNothing; }
