#ifndef PELLUCID_TECHNIQUES_PHOTONS_SENT_LIGHT_GLSL
#define PELLUCID_TECHNIQUES_PHOTONS_SENT_LIGHT_GLSL

// Light that lights send through the texels of their views. Needs: gpu/frame.glsl, light/photon_windows.glsl.

// The light sent through one texel.
struct SentLight {
    vec3 origin;     // m, world
    vec3 direction;  // unit
    vec3 flux;       // W
    vec2 spacing;    // m, and growth in m per m
};

// `disc`: position on a lamp's sphere or a directional light's disc, within the unit disc.
SentLight sent_light(PhotonWindow window, vec2 texel, vec2 disc) {
    vec2 film = vec2(window.film.x + texel.x * window.film.z, window.film.y - texel.y * window.film.w);
    float area = window.film.z * window.film.w;
    SentLight sent;
    if (window.orthographic != 0u) {
        // Rotate the ray about the target point.
        vec3 way = vec3(tan(window.light.half_angle) * disc, -1.0);
        sent.origin = (window.world_from_view * vec4(vec3(film, -window.target_depth) - window.target_depth * way, 1.0)).xyz;
        sent.direction = mat3(window.world_from_view) * normalize(way);
        sent.flux = area * window.light.intensity;
        sent.spacing = vec2(sqrt(area), 0.0);
        return sent;
    }
    vec3 view = vec3(film, -1.0);
    float cosine = inversesqrt(dot(view, view)), solid_angle = area * cosine * cosine * cosine;
    vec3 z = view * cosine, x = normalize(abs(z.x) < 0.5 ? cross(z, vec3(1.0, 0.0, 0.0)) : cross(z, vec3(0.0, 1.0, 0.0)));
    vec3 on_sphere = disc.x * x + disc.y * cross(z, x) + sqrt(max(1.0 - dot(disc, disc), 0.0)) * z;
    sent.origin = (window.world_from_view * vec4(window.light.radius * on_sphere, 1.0)).xyz;
    sent.direction = mat3(window.world_from_view) * z;
    // Evaluate at 1 m from the light without range, because the falloff by range depends on the photon's path length.
    window.light.inverse_range = 0.0;
    sent.flux = solid_angle * window.light.intensity * arriving_light(window.light, window.light.position + sent.direction).irradiance;
    sent.spacing = vec2(0.0, sqrt(solid_angle));
    return sent;
}

#endif
