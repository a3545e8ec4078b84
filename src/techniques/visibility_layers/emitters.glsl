#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_EMITTERS_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_EMITTERS_GLSL

// Points of emissive surfaces, chosen by power. Twin of EmitterRecord in gpu/emitters.h.
// Needs: objects, materials, emitter_count, coincidence (visibility_bindings.glsl); gpu/vertices.glsl, gpu/appearance.glsl,
// gpu/light_sample.glsl.
#include "gpu/emitted_radiance.glsl"

struct EmitterRecord {
    uint object;
    uint triangle;     // over all objects
    float cumulative;  // probability, 0..1, of this triangle and those before it
    float density;     // of sampled points, 1/m2
};
layout(std430, set = 0, binding = 60) readonly buffer Emitters { EmitterRecord emitters[]; };

// The first whose cumulative probability exceeds `choice`, 0..1.
uint chosen_emitter(float choice) {
    uint low = 0u, high = emitter_count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (emitters[middle].cumulative <= choice) low = middle + 1u;
        else high = middle;
    }
    return low;
}

struct EmitterPoint {
    vec3 position;   // m, world
    vec3 outward;    // unit, of the triangle
    vec3 emission;   // radiance
    float density;   // of such points, 1/m2
    bool both_faces; // emit
    uint triangle;
};

// `u`, `choice`: 0..1.
EmitterPoint emitter_point(vec2 u, float choice) {
    EmitterRecord emitter = emitters[chosen_emitter(choice)];
    ObjectRecord o = objects[emitter.object];
    uint corner = o.first_corner + 3u * (emitter.triangle - o.first_triangle);
    uvec3 v = uvec3(indices[corner], indices[corner + 1u], indices[corner + 2u]);
    float root = sqrt(u.x);
    vec3 w = vec3(1.0 - root, root * (1.0 - u.y), root * u.y);
    vec3 a = (o.world_from_object * vec4(vertex_position(v.x), 1.0)).xyz;
    vec3 b = (o.world_from_object * vec4(vertex_position(v.y), 1.0)).xyz;
    vec3 c = (o.world_from_object * vec4(vertex_position(v.z), 1.0)).xyz;
    vec4 texcoords = vec4(0.0), color = vec4(0.0);
    for (int k = 0; k < 3; ++k) {
        texcoords += w[k] * vertex_texcoords(v[k]);
        color += w[k] * vertex_color_of(v[k]);
    }
    MaterialRecord material = materials[o.material];
    vec3 emission = emitted_radiance(material, texcoords.xy, texcoords.zw);
    if ((material.flags & PELLUCID_MATERIAL_COVERAGE) != 0u || material.alpha_cutoff > 0.0) {
        float alpha = material.base_color.a * color.a * sample_texture(material.base_color_texture, texcoords.xy, texcoords.zw).a;
        emission *= material.alpha_cutoff > 0.0 ? step(material.alpha_cutoff, alpha) : min(alpha, 1.0);
    }
    vec3 outward = normalize(cross(b - a, c - a)) * (o.mirrored != 0u ? -1.0 : 1.0);
    return EmitterPoint(w.x * a + w.y * b + w.z * c, outward, emission, emitter.density, (material.flags & PELLUCID_MATERIAL_SINGLE_SIDED) == 0u, emitter.triangle);
}

// Cosine of emission in a unit direction; 0: the face that looks there is dark.
float emission_cosine(EmitterPoint point, vec3 direction) {
    float cos_theta = dot(point.outward, direction);
    return point.both_faces ? abs(cos_theta) : max(cos_theta, 0.0);
}

LightSample sample_emitter(vec3 position, vec2 u, float choice) {
    EmitterPoint point = emitter_point(u, choice);
    vec3 to_point = point.position - position;
    float d2 = max(dot(to_point, to_point), 1e-20), distance_ = sqrt(d2);
    to_point /= distance_;
    // The shadow ray ends before the surface that emits.
    return LightSample(to_point, 0.9999 * distance_ - coincidence,
                       point.emission * (emission_cosine(point, -to_point) / (d2 * point.density)));
}

#endif
