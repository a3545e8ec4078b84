#ifndef PELLUCID_GPU_ENVIRONMENT_SHARES_GLSL
#define PELLUCID_GPU_ENVIRONMENT_SHARES_GLSL

// Samples directions in proportion to the environment's light (environment_shares.h). Needs: gpu/frame.glsl.
// `shares` holds cumulative probabilities: first of the rows, then of the cells in each row.
layout(std430, set = 0, binding = 56) readonly buffer EnvironmentShares {
    uint share_columns, share_rows;
    float shares[];
};

// Index of the first of `count` cumulative shares from `first` on that exceeds `choice`, 0..1. `within`: position of
// `choice` in the interval of that share, 0..1. `share`: probability of the interval.
uint chosen_share(uint first, uint count, float choice, out float within, out float share) {
    uint low = 0u, high = count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (shares[first + middle] <= choice)
            low = middle + 1u;
        else
            high = middle;
    }
    float before = low > 0u ? shares[first + low - 1u] : 0.0;
    share = shares[first + low] - before;
    within = clamp((choice - before) / max(share, 1e-30), 0.0, 1.0);
    return low;
}

// Samples a unit direction towards the environment, uniform within a cell. `pdf`: per steradian. `u`: 0..1.
vec3 sample_environment(vec2 u, out float pdf) {
    const float kPi = 3.14159265;
    float down, across, row_share, share;
    uint row = chosen_share(0u, share_rows, u.y, down, row_share);
    uint column = chosen_share(share_rows + row * share_columns, share_columns, u.x, across, share);
    float step_ = kPi / float(share_rows), top = float(row) * step_;
    pdf = row_share * share * float(share_columns) / (4.0 * kPi * sin(top + 0.5 * step_) * sin(0.5 * step_));
    float cosine = mix(cos(top), cos(top + step_), down), sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    float longitude = ((float(column) + across) / float(share_columns) - 0.5) * 2.0 * kPi;
    vec3 d = vec3(sine * cos(longitude), cosine, sine * sin(longitude));
    return vec3(frame.environment_cosine * d.x + frame.environment_sine * d.z, d.y,
                frame.environment_cosine * d.z - frame.environment_sine * d.x);
}

#endif
