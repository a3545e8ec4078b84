// Runs a round: every patch of the wavefronts advances by some steps, until it must be split or ends. Patches may
// advance by different lengths (Ihrke et al. 2007, section 4.2).
//
// Needs: volume/step_bindings.glsl; void keep_light(VolumeRecord, LightPlacement, PassingLight), which writes the light
// of a step to voxels.

// Side length, in spans, from which a patch that cannot be split leaves its volume and goes straight on. One corner of
// such a patch may circle in a ball for ever while another has left it.
const float kParted = 32.0;
const float kShownSide = 8.0;  // side length, in spans, from which a patch is not shown

void keep_patch(Quad quad) { patches_out[atomicAdd(state.kept, 1u)] = pack_patch(quad); }
void land_patch(Quad quad) { landed[atomicAdd(state.landed, 1u)] = pack_patch(quad); }

// The smallest volume that contains the patch's centre, or else any of its corners.
uint volume_of(Quad quad) {
    vec3 centre = middle(quad.x);
    uint of_corner = PELLUCID_NO_VOLUME;
    for (uint i = 0u; i < volume_count; ++i) {
        VolumeRecord volume = volumes[i];
        if (in_box((volume.voxel_from_world * vec4(centre, 1.0)).xyz, volume.size)) return i;
        bool any_corner = false;
        for (int k = 0; k < 4; ++k)
            any_corner = any_corner || in_box((volume.voxel_from_world * vec4(quad.x[k], 1.0)).xyz, volume.size);
        if (any_corner && of_corner == PELLUCID_NO_VOLUME) of_corner = i;
    }
    return of_corner;
}

// Moves a patch outside all volumes straight on to the first box that a corner meets. All corners move by the same
// length. A patch that meets an opaque surface first, or no box, lands.
void jump(Quad quad) {
    const float kInto = 0.02;  // voxels past the box's face
    float far = 1e30, voxel = 0.0;
    vec3 centre = middle(quad.x), way = normalize(middle(quad.v));
    for (int k = 0; k < 4; ++k) quad.v[k] = normalize(quad.v[k]);
    for (uint i = 0u; i < volume_count; ++i) {
        VolumeRecord volume = volumes[i];
        float nearest = box_distance(volume, centre, way);
        for (int k = 0; k < 4; ++k) nearest = min(nearest, box_distance(volume, quad.x[k], quad.v[k]));
        if (nearest < far) {
            far = nearest;
            voxel = volume.voxel;
        }
    }
    quad.volume = PELLUCID_NO_VOLUME;
    bool lands = far >= 1e30;
    if (kOpaque) lands = lands || first_opaque(centre, way, 0.0, far).t <= far;
    if (lands) {
        land_patch(quad);
        return;
    }
    for (int k = 0; k < 4; ++k) quad.x[k] += (far + kInto * voxel) * quad.v[k];
    quad.optical += far + kInto * voxel;
    keep_patch(quad);
}

bool meets_opaque(vec3 from, vec3 to, VolumeRecord volume) {
    vec3 a = (volume.world_from_voxel * vec4(from, 1.0)).xyz, b = (volume.world_from_voxel * vec4(to, 1.0)).xyz;
    return first_opaque(a, b - a, 0.0, 1.0).t <= 1.0;
}

// Adds an extra patch for the next round. False if the capacity is exhausted.
bool add_patch(Quad quad) {
    // Every patch of this round reserves an entry. Extra patches share the rest of the capacity.
    uint room = capacity - (state.in_kept + state.in_extra);
    uint slot = atomicAdd(state.extra, 1u);
    if (slot < room)
        patches_out[capacity - 1u - slot] = pack_patch(quad);
    else
        atomicAdd(state.refused, 1u);
    return slot < room;
}

void split(Quad quad, bool along_side) {
    Quad first = quad, second = quad;
    first.power = second.power = 0.5 * quad.power;
    first.unabsorbed = second.unabsorbed = 0.5 * quad.unabsorbed;
    // The edges that are cut; corners lie as 0 1 / 3 2.
    int a0 = 0, a1 = along_side ? 1 : 3, b0 = along_side ? 3 : 1, b1 = 2;
    vec3 xa = 0.5 * (quad.x[a0] + quad.x[a1]), xb = 0.5 * (quad.x[b0] + quad.x[b1]);
    vec3 va = 0.5 * (quad.v[a0] + quad.v[a1]), vb = 0.5 * (quad.v[b0] + quad.v[b1]);
    va *= 0.5 * (length(quad.v[a0]) + length(quad.v[a1])) / max(length(va), 1e-6);
    vb *= 0.5 * (length(quad.v[b0]) + length(quad.v[b1])) / max(length(vb), 1e-6);
    first.x[a1] = xa, first.v[a1] = va, first.x[b1] = xb, first.v[b1] = vb;
    second.x[a0] = xa, second.v[a0] = va, second.x[b0] = xb, second.v[b0] = vb;
    if (add_patch(second)) {
        atomicAdd(state.splits, 1u);
        keep_patch(first);
    } else {
        quad.coarse = true;
        keep_patch(quad);
    }
}

void into_world(VolumeRecord volume, inout Quad quad) {
    for (int k = 0; k < 4; ++k) {
        quad.x[k] = (volume.world_from_voxel * vec4(quad.x[k], 1.0)).xyz;
        quad.v[k] = mat3(volume.world_from_voxel) * quad.v[k] / volume.voxel;
    }
}

// A random number in [0, 1) that depends only on the position (PCG: Jarzynski and Olano 2020).
float random_of(vec3 place) {
    uint bits = 0u;
    for (int k = 0; k < 3; ++k) {
        bits = (bits ^ floatBitsToUint(place[k])) * 747796405u + 2891336453u;
        bits = ((bits >> ((bits >> 28u) + 4u)) ^ bits) * 277803737u;
        bits = (bits >> 22u) ^ bits;
    }
    return float(bits >> 8u) / 16777216.0;
}

// Emits the light that a surface has reflected from a patch behind it as a new patch. The power is counted if that
// fails. Russian roulette: a patch with less than half of the least power for splits is dropped at random. Surviving
// patches get its power.
void reflect_patch(VolumeRecord volume, Quad quad, vec3 power) {
    float share = max(power.r, max(power.g, power.b)) / (0.5 * finest * fronts[quad.front].intensity.w);
    if (share < 1.0) {
        if (random_of(quad.x[0]) >= share) return;
        power /= share;
    }
    quad.power = power;
    quad.unabsorbed = power;
    bool follows = mirror_patch(quad, volume.voxel);
    into_world(volume, quad);
    if (!follows || !add_patch(quad)) add_power(PELLUCID_LIGHT_REFLECTED, power);
}

// Stores the patch as it is at a shown wavefront, if the step crosses one.
void show_patch(VolumeRecord volume, vec3 from[4], vec3 to[4], float before, float after, vec3 irradiance) {
    float wavefront = floor(after / shown_spacing) * shown_spacing;
    if (before >= wavefront) return;
    uint slot = atomicAdd(state.shown, 1u);
    if (slot >= uint(shown.length())) return;
    float share = (wavefront - before) / (after - before);
    for (int k = 0; k < 4; ++k)
        shown[slot].position[k].xyz = (volume.world_from_voxel * vec4(mix(from[k], to[k], share), 1.0)).xyz;
    shown[slot].position[0].w = irradiance.r;
    shown[slot].position[1].w = irradiance.g;
    shown[slot].position[2].w = irradiance.b;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= state.in_kept + state.in_extra) return;
    Quad quad = unpack_patch(patches_in[i < state.in_kept ? i : capacity - 1u - (i - state.in_kept)]);
    uint own = volume_of(quad);
    if (own == PELLUCID_NO_VOLUME) {
        jump(quad);
        return;
    }
    VolumeRecord volume = volumes[own];
    LightPlacement placement = placements[own];
    enter_volume(volume, floatBitsToUint(fronts[quad.front].cone.w));
    for (int k = 0; k < 4; ++k) {
        quad.x[k] = (volume.voxel_from_world * vec4(quad.x[k], 1.0)).xyz;
        quad.v[k] = mat3(volume.voxel_from_world) * quad.v[k] * volume.voxel;
        if (quad.volume != own) quad.v[k] = normalize(quad.v[k]) * (in_box(quad.x[k], volume_size) ? index_field(quad.x[k]).w : 1.0);
    }
    if (quad.volume != own) quad.surface = vec4(0.0);
    quad.volume = own;
    float handed = determinant(mat3(volume.voxel_from_world)) < 0.0 ? -1.0 : 1.0;
    float first_power = fronts[quad.front].intensity.w;
    float most_power = max(quad.unabsorbed.r, max(quad.unabsorbed.g, quad.unabsorbed.b));
    bool may_split = !quad.coarse && most_power > finest * first_power;
    quad.coarse = false;

    bool going = true, wants_split = false, along_side = false, lands = false, parted = false, turned = false, weak = false;
    vec3 mirrored = vec3(0.0);  // power that continues as a new patch
    for (uint s = 0u; s < steps_per_round && going; ++s) {
        float side = max(distance(quad.x[0], quad.x[1]), distance(quad.x[3], quad.x[2]));
        float up = max(distance(quad.x[0], quad.x[3]), distance(quad.x[1], quad.x[2]));
        if (may_split && max(side, up) > span) {
            wants_split = true;
            along_side = side > up;
            break;
        }
        vec3 x[4] = quad.x, v[4] = quad.v;
        vec3 from = middle(x);
        for (int k = 0; k < 4; ++k) step_corner(x[k], v[k], step_length);
        vec3 to = middle(x);
        if (kOpaque) {
            if (meets_opaque(from, to, volume)) {
                lands = true;
                break;
            }
        }
        vec3 v_before = mean_v(quad.v);
        // At a point focus both sides of the patch reverse at once.
        bool reversed = dot(x[1] - x[0], quad.x[1] - quad.x[0]) < 0.0 || dot(x[3] - x[0], quad.x[3] - quad.x[0]) < 0.0;
        vec3 old[4] = quad.x;
        quad.x = x;
        quad.v = v;
        vec3 half_way = 0.5 * (from + to);
        float travelled = distance(from, to), optical_before = quad.optical;
        quad.optical += step_length * volume.voxel;
        vec3 area = 0.5 * cross(x[2] - x[0], x[3] - x[1]) * handed;
        vec3 way = normalize(middle(v));
        float facing = dot(area, way);
        vec3 mean_power = quad.power;
        if ((kMedium || kBoundary) && in_box(half_way, volume_size)) {
            vec4 absorption = volume_value(volume_absorption, half_way);
            vec3 extinction = absorption.rgb;
            if (kScatters) extinction += volume_value(volume_scattering, half_way).rgb;
            float near, far;  // part of the step inside the box
            clip_to_box(volume, from, to - from, near, far);
            vec3 depth = extinction * travelled * max(min(far, 1.0) - near, 0.0);
            mean_power *= mean_transmittance(depth);
            quad.power *= exp(-depth);
            if (kBoundary) {
                vec3 reflected = quad.power * crossed_surface(quad.surface, absorption.a, in_box(to, volume_size), from, v_before, to, mean_v(v));
                quad.power -= reflected;
                quad.unabsorbed -= reflected;
                float most_reflected = max(reflected.r, max(reflected.g, reflected.b));
                if (quad.reflections < reflections && most_reflected >= weakest * first_power && most_reflected > 0.0)
                    mirrored = reflected;
                else
                    add_power(PELLUCID_LIGHT_REFLECTED, reflected);
            }
        }
        keep_light(volume, placement,
                   PassingLight(old, x, way, facing, quad.power, mean_power, travelled * volume.voxel,
                                most_power / first_power, s));
        if (kShown && max(side, up) < kShownSide * span)
            show_patch(volume, old, x, optical_before, quad.optical,
                       mean_power / (max(abs(facing), least_area) * volume.voxel * volume.voxel));
        turned = !kKeepFolds && (facing < 0.0 || reversed);
        weak = max(quad.power.r, max(quad.power.g, quad.power.b)) < weakest * first_power;
        bool outside = !in_box(to, volume_size), straddles = false;
        for (int k = 0; k < 4; ++k) {
            bool out_there = !in_box(x[k], volume_size);
            outside = outside && out_there;
            straddles = straddles || out_there;
        }
        parted = !may_split && straddles && max(side, up) > kParted * span;
        going = !turned && !weak && !outside && !parted && mirrored == vec3(0.0);
        if (kOverlapping) {
            for (uint j = 0u; j < own; ++j) {
                vec3 world = (volume.world_from_voxel * vec4(to, 1.0)).xyz;
                going = going && !in_box((volumes[j].voxel_from_world * vec4(world, 1.0)).xyz, volumes[j].size);
            }
        }
    }
    if (kBoundary) {
        if (mirrored != vec3(0.0)) reflect_patch(volume, quad, mirrored);
    }
    into_world(volume, quad);
    if (turned)
        end_patch(quad, PELLUCID_LIGHT_TURNED);
    else if (weak)
        end_patch(quad, PELLUCID_LIGHT_WEAK);
    else if (lands || parted)
        land_patch(quad);
    else if (wants_split)
        split(quad, along_side);
    else
        keep_patch(quad);
}
