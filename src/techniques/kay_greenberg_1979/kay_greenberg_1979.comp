#version 460
// Kay & Greenberg, "Transparency for Computer Synthesized Images", SIGGRAPH 1979: surfaces are composited over a
// background image from back to front, FINAL = OLD t + NEW (1 - t). Section numbers are the paper's.
//
// The paper rewrites the whole image once per surface: pass r composites each pixel's r-th surface from the back over
// the previous image, read at a displaced pixel. Following one pixel from the last pass to the first gives the same
// sum without intermediate images.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "techniques/technique_bindings.glsl"

layout(set = 0, binding = 15) uniform texture2D environment_map;

#include "gpu/diffuse.glsl"
#include "gpu/environment_lookup.glsl"
#include "gpu/light_parts.glsl"
#include "layers/pixel_list.glsl"
#include "techniques/kay_greenberg_1979/surface_light.glsl"

layout(local_size_x = PELLUCID_LIST_GROUP) in;

layout(constant_id = 0) const bool kLit = false;  // the scene has lights

const uint kLinear = 0u;
const uint kNonLinear = 1u;

layout(set = 0, binding = 10, r32f) readonly uniform image2DArray opaque_depth;
layout(set = 0, binding = 11, rgba32f) readonly uniform image2DArray opaque_radiance;
layout(set = 0, binding = 12, r32ui) readonly uniform uimage2DArray opaque_object;
layout(set = 0, binding = 13, rgba32f) writeonly uniform image2DArray path_radiance;
layout(set = 0, binding = 16, rgba32f) writeonly uniform image2DArray reflected_radiance;  // written only if kLit

layout(push_constant) uniform Push {
    uint mode;
    uint surfaces;  // surfaces considered; one more layer exists, to detect further surfaces
    float power;    // p of section 2.2
    float min_transparency;
    float max_transparency;
    float thickness;         // h, metres
    float log_transmission;  // log of T1 per metre, <= 0
    uint own_slabs;          // 1: h and T1 come from the surface's material
    uint light_count;
    float least_alpha;  // least GGX width of highlights
};

// State of a pixel while it passes through the images, last image first.
struct View {
    vec2 pixel;  // position at which the image is read; centres at +0.5
    vec3 transmittance;
    vec3 radiance;  // sum of the NEW terms
    vec3 highlights;
    float length_inside;
    float depth;  // depth of the last surface
    uint events;
    uint status;
};

ivec2 texel_at(vec2 pixel) {
    return clamp(ivec2(floor(pixel)), ivec2(0), ivec2(frame.width, frame.height) - 1);
}

bool in_picture(vec2 pixel) {
    return all(greaterThanEqual(pixel, vec2(0.0))) && all(lessThan(pixel, vec2(frame.width, frame.height)));
}

// Number of a pixel's surfaces in front of the opaque surface, at most one more than are considered.
uint count_surfaces(ivec2 texel) {
    float end = imageLoad(opaque_depth, ivec3(texel, 0)).r;
    uint count = 0u;
    while (count <= surfaces && imageLoad(layer_depth, ivec3(texel, count)).r < end) ++count;
    return count;
}

// NEW: radiance of the surface as if it were opaque. Shading later multiplies all light through glass by the first
// surface's colour, `tint`, so divide by it here.
vec3 own_radiance(MaterialRecord material, vec3 tint, vec3 facing, vec3 irradiance_of_lights) {
    vec3 albedo = material.base_color.rgb / max(tint, vec3(1e-4));
    vec3 own = diffuse_radiance(albedo, mat3(frame.world_from_view) * facing);
    return drawn(PELLUCID_DIRECT, kLit ? own + albedo * irradiance_of_lights / kLightPi : own);
}

SurfaceLight light_on_surface(View view, MaterialRecord material, vec3 facing, float depth) {
    vec3 position = (frame.world_from_view * vec4(view_position(view.pixel, depth), 1.0)).xyz;
    vec3 to_eye = -normalize(mat3(frame.world_from_view) * camera_ray(view.pixel).direction);
    float alpha = max(material.roughness * material.roughness, least_alpha);
    return light_on(LitSurface(position, normalize(mat3(frame.world_from_view) * facing), to_eye, material.ior, alpha),
                    light_count);
}

// Thickness of a surface's slab by its material, metres in world space.
float own_thickness(ObjectRecord object, MaterialRecord material) {
    return material.sigma_a.a * pow(abs(determinant(mat3(object.world_from_object))), 1.0 / 3.0);
}

// Section 4.2, A and B: rays outside media run along -Z of the view; the surface is a slab of thickness h. Moves to
// the pixel behind the slab and returns t.
vec3 cross_slab(inout View view, ObjectRecord object, MaterialRecord material, vec3 facing, float depth) {
    vec3 inside;
    refract_direction(vec3(0.0, 0.0, -1.0), facing, 1.0 / material.ior, inside);
    float h = own_slabs != 0u ? own_thickness(object, material) : thickness;
    float distance = h / max(-dot(facing, inside), 1e-4);
    vec2 metres_per_pixel = frame.film.zw * (frame.orthographic != 0u ? 1.0 : depth);
    view.pixel += distance * vec2(inside.x, -inside.y) / metres_per_pixel;
    view.length_inside += distance;
    return exp(log_transmission * distance) * beer_lambert(material.sigma_a.rgb, distance);
}

void cross_surface(inout View view, ivec2 texel, uint layer, vec3 tint) {
    Fragment fragment = load_fragment(texel, layer);
    ObjectRecord object = objects[find_object(triangle_index(fragment.triangle))];
    MaterialRecord material = materials[object.material];
    vec3 normal = view_normal(texel, layer);
    vec3 facing = normal.z < 0.0 ? -normal : normal;
    SurfaceLight light = SurfaceLight(vec3(0.0), vec3(0.0));
    if (kLit) light = light_on_surface(view, material, facing, fragment.depth);
    vec3 t = vec3(max_transparency);
    if (mode == kNonLinear) {  // section 2.2
        float grazing = 1.0 - min(facing.z, 1.0);
        t = vec3(mix(min_transparency, max_transparency, 1.0 - pow(grazing, power)));
    } else if (mode != kLinear) {
        t = cross_slab(view, object, material, facing, fragment.depth);
    }
    view.radiance += view.transmittance * (1.0 - t) * own_radiance(material, tint, facing, light.irradiance);
    view.highlights += light.highlight;
    view.transmittance *= t;
    view.depth = fragment.depth;
    ++view.events;
}

// Stores the background under the view's pixel: an opaque surface, or the environment along its view ray.
void store(ivec2 texel, View view) {
    ivec2 behind = texel_at(view.pixel);
    float opaque = imageLoad(opaque_depth, ivec3(behind, 0)).r;
    bool hidden = opaque < PELLUCID_EMPTY_DEPTH;
    if (hidden) view.radiance += view.transmittance * imageLoad(opaque_radiance, ivec3(behind, 0)).rgb;
    vec3 end = view_position(view.pixel, hidden ? opaque : view.depth);
    Path path = Path(end, camera_ray(view.pixel).direction, view.transmittance, view.length_inside, view.events, 0u,
                     view.status, false);
    store_refraction(texel, path);
    ivec3 at = ivec3(texel, 0);
    if (hidden) {
        vec3 world = (frame.world_from_view * vec4(end, 1.0)).xyz;
        imageStore(exit_position, at, vec4(world, float(imageLoad(opaque_object, ivec3(behind, 0)).r)));
    }
    imageStore(path_radiance, at, vec4(view.radiance, hidden ? 1.0 : 0.0));
}

// Stores the light added after all surfaces (section 2.2): their highlights, and the environment's reflection at the
// first surface.
void store_reflected(ivec2 texel, vec3 highlights) {
    Fragment first = load_fragment(texel, 0u);
    vec3 direction = mat3(frame.world_from_view) * camera_ray(vec2(texel) + 0.5).direction;
    vec3 normal = mat3(frame.world_from_view) * view_normal(texel, 0u), mirrored = vec3(0.0);
    if (!back_face(first.triangle))
        mirrored = fresnel_dielectric(-dot(direction, normal), 1.0 / material_of(first).ior) *
                   environment_radiance(reflect_direction(direction, normal));
    imageStore(reflected_radiance, ivec3(texel, 0),
               vec4(drawn(PELLUCID_EMITTED, mirrored) + drawn(PELLUCID_DIRECT, highlights), 1.0));
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;

    uint count = count_surfaces(texel);
    View view = View(vec2(texel) + 0.5, vec3(1.0), vec3(0.0), vec3(0.0), 0.0, 0.0, 0u, kStatusOk);
    // An opaque object may stand inside the glass. Without one, an odd count means an open mesh.
    bool cut = imageLoad(opaque_depth, ivec3(texel, 0)).r < PELLUCID_EMPTY_DEPTH;
    if (count > surfaces) view.status = kStatusEventLimit;
    else if ((count & 1u) != 0u && !cut) view.status = kStatusMissingLayer;
    vec3 tint = material_of(load_fragment(texel, 0u)).base_color.rgb;

    // Surface r from the back. Where a pixel has fewer surfaces, the pass does not change it.
    for (uint r = min(count, surfaces); r > 0u; --r) {
        if (!in_picture(view.pixel)) {
            view.status = kStatusLeftScreen;
            break;
        }
        ivec2 at = texel_at(view.pixel);
        uint here = min(count_surfaces(at), surfaces);
        if (r <= here) cross_surface(view, at, here - r, tint);
    }
    store(texel, view);
    if (kLit) store_reflected(texel, view.highlights);
}
