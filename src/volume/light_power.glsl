#ifndef PELLUCID_VOLUME_LIGHT_POWER_GLSL
#define PELLUCID_VOLUME_LIGHT_POWER_GLSL

// Counts the power of light by its fate. Needs: volume/light_patch.glsl; buffer State { LightState state; }.
void add_power(uint fate, vec3 power) {
    for (int c = 0; c < 3; ++c)
        if (power[c] > 0.0) {
            uvec2 units = power_units(power[c]);
            PELLUCID_ADD_WIDE(state.power, 3u * fate + c, units)
        }
}

void end_patch(Quad quad, uint fate) {
    add_power(fate, quad.power);
    add_power(PELLUCID_LIGHT_ABSORBED, quad.unabsorbed - quad.power);
}

#endif
