#ifndef PELLUCID_GPU_STRETCH_GLSL
#define PELLUCID_GPU_STRETCH_GLSL

// Segments of rays in image space, for searches in depth images. Needs: gpu/frame.glsl.

// A segment of a ray: pixel coordinates, and a depth value that is linear in them. The value is the depth of an
// orthographic camera, or the inverse depth of a perspective one.
struct Stretch {
    vec2 from, to;
    float at_from, at_to;
};

float linear_depth(float depth) { return frame.orthographic != 0u ? depth : 1.0 / depth; }  // its own inverse

Stretch stretch_of(vec3 from, vec3 to) {
    return Stretch(project(from), project(to), linear_depth(-from.z), linear_depth(-to.z));
}

vec2 pixel_at(Stretch s, float share) { return mix(s.from, s.to, share); }
float depth_at(Stretch s, float share) { return linear_depth(mix(s.at_from, s.at_to, share)); }

ivec2 texel_at(Stretch s, float share) {
    return clamp(ivec2(floor(pixel_at(s, share))), ivec2(0), ivec2(frame.width, frame.height) - 1);
}

vec3 position_at(Stretch s, float share) { return view_position(pixel_at(s, share), depth_at(s, share)); }

// The share of a stretch, from its beginning, that lies within the image. Negative if it begins outside the image.
float share_within_picture(Stretch s) {
    if (any(lessThan(s.from, vec2(0.0))) || any(greaterThanEqual(s.from, vec2(frame.width, frame.height)))) return -1.0;
    vec2 step = s.to - s.from;
    float share = 1.0;
    for (int axis = 0; axis < 2; ++axis) {
        float edge = step[axis] > 0.0 ? float(axis == 0 ? frame.width : frame.height) : 0.0;
        if (step[axis] != 0.0) share = min(share, max((edge - s.from[axis]) / step[axis], 0.0));
    }
    return share;
}

#endif
