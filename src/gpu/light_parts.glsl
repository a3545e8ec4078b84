#ifndef PELLUCID_GPU_LIGHT_PARTS_GLSL
#define PELLUCID_GPU_LIGHT_PARTS_GLSL

// Parts of an image's light, by the surfaces on the path to the eye. In Heckbert's notation, with D for every surface
// that is not smooth: `emitted` is E S* L, `direct` E S* D L, `caustic` E S* D S+ L, and `indirect` E S* D (S* D)+ S*
// L. Needs: gpu/frame.glsl.

// Whether the frame draws light of this part.
bool draws_part(uint part) { return frame.light_part == PELLUCID_ALL_LIGHT || frame.light_part == part; }

vec3 drawn(uint part, vec3 light) { return draws_part(part) ? light : vec3(0.0); }

#endif
