#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_OPAQUE_POINT_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_OPAQUE_POINT_GLSL

// Where paths end on opaque surfaces. Needs: end_paths.glsl as far as it includes this.

// The opaque surface at which a path has ended.
struct OpaquePoint {
    OpaqueSurface surface;
    vec3 normal;    // unit, on the path's side
    vec3 emission;  // radiance; of an unlit surface its base colour, which is all that is seen of it
    bool unlit;
    bool translucent;
    bool reflects_photons;
    float alpha;    // below 0 where there is a hole
    float ior;      // of the medium on the path's side
};

// Of a path's end at a surface that is there in part; see gpu/coverage.glsl.
float alpha_margin_of(PathState state, MaterialRecord material, float alpha) {
    bool rasterised = has_mark(state, kOpaquePixel) && has_mark(state, kMainPath);
    uint ray = rasterised ? 0u : 1u + state.path.events + 64u * bounces(state) + (has_mark(state, kToLight) ? 1024u : 0u);
    ivec2 pixel = ivec2(state.pixel % frame.width, state.pixel / frame.width) + first_pixel();
    return alpha_margin(material, alpha, pixel, state.standing, ray);
}

OpaquePoint opaque_point(PathState state) {
    Path path = state.path;
    uint standing = state.standing, object = object_of(standing);
    ObjectRecord o = objects[object];
    uint corner = o.first_corner + 3u * (standing - o.first_triangle);
    uvec3 v = uvec3(indices[corner], indices[corner + 1u], indices[corner + 2u]);
    vec3 a = (o.world_from_object * vec4(vertex_position(v.x), 1.0)).xyz;
    vec3 edge_b = (o.world_from_object * vec4(vertex_position(v.y), 1.0)).xyz - a;
    vec3 edge_c = (o.world_from_object * vec4(vertex_position(v.z), 1.0)).xyz - a;
    vec3 w = corner_weights(path.direction, a - path.position, edge_b, edge_c);
    vec3 normal = mat3(o.world_from_object_normal) *
                  (w.x * vertex_normal(v.x) + w.y * vertex_normal(v.y) + w.z * vertex_normal(v.z));
    if (!(dot(normal, normal) > 1e-30)) normal = cross(edge_b, edge_c);
    normal = normalize(normal);
    vec4 texcoords = vec4(0.0), color = vec4(0.0);
    for (int k = 0; k < 3; ++k) {
        texcoords += w[k] * vertex_texcoords(v[k]);
        color += w[k] * vertex_color_of(v[k]);
    }
    MaterialRecord material = materials[o.material];
    vec4 base = material.base_color * color * sample_texture(material.base_color_texture, texcoords.xy, texcoords.zw);
    OpaquePoint point;
    point.surface = opaque_surface(material, base.rgb, TexturedPoint(v, w, edge_b, edge_c, texcoords), o, normal,
                                   -path.direction, point.normal);
    point.unlit = (material.flags & PELLUCID_MATERIAL_UNLIT) != 0u;
    point.emission = point.unlit ? base.rgb : emitted_radiance(material, texcoords.xy, texcoords.zw);
    point.translucent = material.translucent != 0u;
    point.reflects_photons = reflects_photons(material);
    point.alpha = alpha_margin_of(state, material, base.a);
    point.ior = filling_iors(filling_body(state.media)).g;
    return point;
}

vec3 diffuse_albedo(OpaquePoint point, vec3 to_viewer) {
    return point.unlit ? vec3(0.0) : opaque_diffuse_albedo(point.surface, point.normal, to_viewer);
}

#endif
