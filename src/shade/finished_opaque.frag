#version 460
// Of scenes where some opaque surface has a finish, a normal texture or an occlusion texture.
const bool kFinishes = true;
#extension GL_GOOGLE_include_directive : require
#include "shade/opaque_fragment.glsl"
