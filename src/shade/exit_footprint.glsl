#ifndef PELLUCID_SHADE_EXIT_FOOTPRINT_GLSL
#define PELLUCID_SHADE_EXIT_FOOTPRINT_GLSL

// Footprint of a pixel in the environment (Igehy, "Tracing Ray Differentials", SIGGRAPH 1999, by finite differences):
// neighbouring pixels whose paths have the same events tell how the exit direction changes over the pixel. Needs:
// exit_direction, path_events.

// Change of the exit direction from one pixel to the next along `step`; 0 if neither neighbour has a comparable path.
vec3 exit_difference(ivec3 at, ivec2 step) {
    vec3 here = imageLoad(exit_direction, at).xyz, sum = vec3(0.0);
    uint events = imageLoad(path_events, at).r;
    float count = 0.0;
    for (int side = -1; side <= 1; side += 2) {
        ivec3 beside = at + ivec3(side * step, 0);
        if (any(lessThan(beside.xy, ivec2(0))) || any(greaterThanEqual(beside.xy, imageSize(path_events).xy))) continue;
        if (imageLoad(path_events, beside).r != events) continue;
        sum += float(side) * (imageLoad(exit_direction, beside).xyz - here);
        count += 1.0;
    }
    return count > 0.0 ? sum / count : vec3(0.0);
}

// Mean of the environment over samples x samples directions in the footprint.
vec3 environment_over_footprint(ivec3 at, uint samples) {
    vec3 direction = imageLoad(exit_direction, at).xyz;
    vec3 along_x = exit_difference(at, ivec2(1, 0)), along_y = exit_difference(at, ivec2(0, 1));
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < samples * samples; ++i) {
        vec2 offset = (vec2(i % samples, i / samples) + 0.5) / float(samples) - 0.5;
        sum += environment_radiance(normalize(direction + offset.x * along_x + offset.y * along_y));
    }
    return sum / float(samples * samples);
}

#endif
