#version 460
const bool kFinishes = false;
#extension GL_GOOGLE_include_directive : require
#include "shade/opaque_fragment.glsl"
