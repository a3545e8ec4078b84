#ifndef PELLUCID_TECHNIQUES_WANG_2014_SEARCH_EXIT_GLSL
#define PELLUCID_TECHNIQUES_WANG_2014_SEARCH_EXIT_GLSL

// Search of the exit of a ray inside the object: Wang 2014, sections 3.3, 3.5 and 5.2. Needs: search.glsl.

// 0: below a fault a ray waits until it comes out again. 1: there it follows the layers around it (5.2). 2: it follows
// them from its start.
layout(constant_id = 1) const uint kBelowFaults = 0u;
layout(constant_id = 2) const bool kFrontExits = false;  // reflected rays leave through layers of entries, too
layout(constant_id = 3) const bool kSteepWalls = false;  // a jump to the outside is a wall

const uint kNoLayer = 0xffffffffu;

// The layer of exits that ends the solid around a point of the ray; kNoLayer: the point is outside.
uint exit_around(ScreenRay ray, float distance) {
    ivec2 texel = texel_at(pixel_at(ray, distance));
    float depth = depth_at(ray, distance);
    for (uint exit = 1u; exit < uint(imageSize(merged_depth).z); exit += 2u) {
        if (texel_depth(texel, exit - 1u) < depth && depth <= texel_depth(texel, exit)) return exit;
    }
    return kNoLayer;
}

// Follows the pair of an entry layer and an exit layer that the ray is in. At a jump of either, the ray changes to
// the pair behind the jump.
Hit search_pairs(Walk walk) {
    uint exit = exit_around(walk.ray, walk.after);
    while (true) {
        uint crossed = kNoLayer;
        while (crossed == kNoLayer && step_on(walk)) {
            vec2 pixel = pixel_at(walk.ray, walk.after);
            float depth = depth_at(walk.ray, walk.after);
            if (exit == kNoLayer) exit = exit_around(walk.ray, walk.after);
            else if (depth > stored_depth(pixel, exit)) crossed = exit;
            else if (depth < stored_depth(pixel, exit - 1u)) crossed = exit - 1u;
        }
        if (crossed == kNoLayer) return no_hit(walk);
        float jump;
        float hit = binary_search(walk, crossed, crossed != exit, jump);
        bool may_leave = crossed == exit || kFrontExits;
        bool surface = jump <= fault_size;
        exit = surface ? kNoLayer : exit_around(walk.ray, walk.after);
        if (may_leave && (surface || (kSteepWalls && exit == kNoLayer))) return Hit(hit, crossed, kStatusOk);
    }
}

// Searches along a world-space ray for its exit. `reflected`: the ray starts on a surface that has reflected it.
Hit search_exit(vec3 world_origin, vec3 world_direction, bool reflected) {
    Walk walk = begin_walk(world_origin, world_direction, reflected, false);
    bool pairs = kBelowFaults == 2u || (kFrontExits && reflected);
    bool behind = reflected && is_behind(walk.ray, walk.after);
    while (!pairs && pass_layer(walk, behind)) {
        float jump;
        float hit = binary_search(walk, layer, false, jump);
        if (jump <= fault_size) return Hit(hit, layer, kStatusOk);  // case 3; otherwise case 2: below the fault
        if (kSteepWalls && exit_around(walk.ray, walk.after) == kNoLayer) return Hit(hit, layer, kStatusOk);
        pairs = kBelowFaults != 0u;
    }
    if (pairs) return search_pairs(walk);
    return no_hit(walk);
}

#endif
