#ifndef PELLUCID_GPU_OPAQUE_MATERIAL_GLSL
#define PELLUCID_GPU_OPAQUE_MATERIAL_GLSL

// Opaque surfaces from materials and their textures. Needs: gpu/opaque_surface.glsl, which includes this.

vec4 texel_at(uint texture_index, TexturedPoint point) {
    return sample_texture(texture_index, point.texcoords.xy, point.texcoords.zw);
}

// The coat and the fibres. `outward`: unit, interpolated. `side`: -1 where the viewer sees the back.
Layers layers_of(FinishRecord finish, TexturedPoint point, ObjectRecord object, vec3 outward, float side, vec3 to_viewer) {
    Layers layers = kNoLayers;
    layers.coat = finish.clearcoat;
    if (layers.coat > 0.0) {
        layers.coat *= texel_at(finish.clearcoat_texture, point).r;
        layers.coat_roughness = finish.clearcoat_roughness * texel_at(finish.clearcoat_roughness_texture, point).g;
        layers.coat_normal = seen_normal(point, object, outward, side, finish.clearcoat_normal_texture,
                                         finish.clearcoat_normal_scale, to_viewer);
    }
    if (finish.sheen.rgb != vec3(0.0)) {
        layers.sheen = finish.sheen.rgb * texel_at(finish.sheen_color_texture, point).rgb;
        layers.sheen_roughness = finish.sheen.a * texel_at(finish.sheen_roughness_texture, point).a;
    }
    return layers;
}

// Width of facets along `along`, from the width across; 0: the lobe is round, as where texture coordinates say no direction.
float stretch_of(FinishRecord finish, TexturedPoint point, ObjectRecord object, vec3 normal, float side, float alpha, out vec3 along) {
    along = vec3(0.0);
    float strength = finish.anisotropy;
    if (strength == 0.0) return 0.0;
    vec2 direction = vec2(1.0, 0.0);
    bool known, second_set = false;
    if (finish.anisotropy_texture != PELLUCID_NO_TEXTURE) {
        vec4 texel = texel_at(finish.anisotropy_texture, point);
        strength *= texel.b;
        direction = 2.0 * texel.rg - 1.0;
        float length_ = length(direction);
        direction = length_ > 0.0 ? direction / length_ : vec2(1.0, 0.0);
        second_set = (textures[finish.anisotropy_texture].flags & PELLUCID_TEXTURE_SECOND_SET) != 0u;
    }
    vec2 turn = vec2(finish.anisotropy_cosine, finish.anisotropy_sine);
    direction = vec2(turn.x * direction.x - turn.y * direction.y, turn.y * direction.x + turn.x * direction.y);
    mat3 frame_ = texture_frame(point, object, side * normal, second_set, known);
    along = frame_ * vec3(direction, 0.0);
    return known && strength > 0.0 ? max(mix(alpha, 1.0, strength * strength), kLeastStretched) : 0.0;
}

// Reflectance of the boundary as extensions change it. A film's is taken at the viewer's angle to the normal.
void apply_boundary(FinishRecord finish, TexturedPoint point, float ior, float metallic, vec3 base, float cos_viewer, inout OpaqueSurface surface) {
    float specular = finish.specular.a * texel_at(finish.specular_texture, point).a;
    vec3 color = finish.specular.rgb * texel_at(finish.specular_color_texture, point).rgb;
    vec3 dielectric = specular * min(surface.boundary.x * color, vec3(1.0));
    float grazing = ior > 1.0 ? specular : 0.0;
    surface.at_normal = mix(dielectric, base, metallic);
    surface.at_grazing = mix(vec3(grazing), vec3(greaterThan(base, vec3(0.0))), metallic);
    surface.boundary = vec2(largest(dielectric), grazing);
    if (finish.iridescence == 0.0) return;
    float share = finish.iridescence * texel_at(finish.iridescence_texture, point).r;
    float thickness = mix(finish.film_thinnest_nm, finish.film_thickest_nm, texel_at(finish.film_thickness_texture, point).g);
    vec3 film = film_reflectance(cos_viewer, finish.film_ior, thickness, surface.at_normal);
    float over_diffuse = largest(film_reflectance(cos_viewer, finish.film_ior, thickness, vec3(surface.boundary.x)));
    surface.at_normal = mix(surface.at_normal, film, share);
    surface.at_grazing = mix(surface.at_grazing, film, share);
    surface.boundary = mix(surface.boundary, vec2(over_diffuse), share);
}

// Of a material at a point. `base`: its base colour with textures; `outward`: unit, interpolated. `normal` becomes the
// surface's on the viewer's side, with its texture.
OpaqueSurface opaque_surface(MaterialRecord material, vec3 base, TexturedPoint point, ObjectRecord object, vec3 outward,
                             vec3 to_viewer, out vec3 normal) {
    normal = faceforward(outward, -to_viewer, outward);
    vec2 factors = texel_at(material.metallic_roughness_texture, point).bg;
    float metallic = material.metallic * factors.x;
    float root = (material.ior - 1.0) / (material.ior + 1.0), head_on = root * root;
    OpaqueSurface surface;
    surface.diffuse = (1.0 - metallic) * base;
    surface.roughness = material.roughness * factors.y;
    surface.at_normal = mix(vec3(head_on), base, metallic);
    // Where nothing is reflected head-on there is no boundary to reflect at grazing angles either.
    surface.at_grazing = vec3(greaterThan(surface.at_normal, vec3(0.0)));
    surface.boundary = vec2(head_on, head_on > 0.0 ? 1.0 : 0.0);
    surface.occlusion = 1.0;
    surface.layers = kNoLayers;
    if (!kFinishes) return surface;
    if (frame.occlusion != 0u) surface.occlusion = mix(1.0, texel_at(material.occlusion_texture, point).r, material.occlusion_strength);
    float side = dot(normal, outward) < 0.0 ? -1.0 : 1.0;
    normal = seen_normal(point, object, outward, side, material.normal_texture, material.normal_scale, to_viewer);
    if (material.finish == PELLUCID_NO_FINISH) return surface;
    FinishRecord finish = finishes[material.finish];
    surface.layers = layers_of(finish, point, object, outward, side, to_viewer);
    vec3 along;
    surface.layers.stretch = stretch_of(finish, point, object, normal, side, surface.roughness * surface.roughness, along);
    surface.layers.along = along;
    apply_boundary(finish, point, material.ior, metallic, base, clamp(dot(normal, to_viewer), 0.0, 1.0), surface);
    return surface;
}

// Radiance towards the viewer, who sees it directly, of a point of a surface; arguments as above. Emission is added.
vec3 opaque_material_radiance(MaterialRecord material, vec3 base, TexturedPoint point, ObjectRecord object, vec3 outward,
                              vec3 to_viewer) {
    if ((material.flags & PELLUCID_MATERIAL_UNLIT) != 0u) return drawn(PELLUCID_EMITTED, base);
    vec3 normal;
    OpaqueSurface surface = opaque_surface(material, base, point, object, outward, to_viewer, normal);
    return opaque_radiance(surface, normal, to_viewer, PELLUCID_DIRECT, PELLUCID_EMITTED) +
           drawn(PELLUCID_EMITTED, emitted_radiance(material, point.texcoords.xy, point.texcoords.zw));
}

#endif
