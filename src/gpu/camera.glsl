#ifndef PELLUCID_GPU_CAMERA_GLSL
#define PELLUCID_GPU_CAMERA_GLSL

// The camera, in view space: right-handed, looking along -Z, depth = -z in metres.
// An image is drawn in one or more tiles. Pixels count from the tile's corner unless stated otherwise.
// Needs: frame (FrameConstants).

struct Ray {
    vec3 origin;
    vec3 direction;  // unit
};

// First pixel of the tile, in the whole image.
ivec2 first_pixel() { return ivec2(frame.first_x, frame.first_y); }

vec2 film_point(vec2 pixel) {
    pixel += vec2(first_pixel());  // exact, so every tile gets the rays of the whole image
    return vec2(frame.film.x + pixel.x * frame.film.z, frame.film.y - pixel.y * frame.film.w);
}

// Ray through a pixel coordinate; pixel centres are at +0.5.
Ray camera_ray(vec2 pixel) {
    vec2 p = film_point(pixel);
    if (frame.orthographic != 0u) return Ray(vec3(p, 0.0), vec3(0.0, 0.0, -1.0));
    return Ray(vec3(0.0), normalize(vec3(p, -1.0)));
}

vec3 view_position(vec2 pixel, float depth) {
    vec2 p = film_point(pixel);
    return vec3(frame.orthographic != 0u ? p : p * depth, -depth);
}

// Pixel coordinate, in the whole image, of a view-space point in front of the camera (depth > 0 for perspective).
vec2 project_to_picture(vec3 position) {
    vec2 p = frame.orthographic != 0u ? position.xy : position.xy / -position.z;
    return vec2(p.x - frame.film.x, frame.film.y - p.y) / frame.film.zw;
}

vec2 project(vec3 position) { return project_to_picture(position) - vec2(first_pixel()); }

#endif
