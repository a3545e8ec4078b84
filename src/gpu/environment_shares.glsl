#ifndef PELLUCID_GPU_ENVIRONMENT_SHARES_GLSL
#define PELLUCID_GPU_ENVIRONMENT_SHARES_GLSL

// Directions chosen by the environment's light (environment_shares.h). Needs: gpu/frame.glsl.
// Of the rows, then of the cells in each row: the probability of those up to and including it.
layout(std430, set = 0, binding = 56) readonly buffer EnvironmentShares {
    uint share_columns, share_rows;
    float shares[];
};

// The first of `count` shares from `first` on that exceeds `choice`, 0..1. `within`: where in its interval `choice` lies, 0..1;
// `share`: its probability.
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

// A unit direction away from the scene; `pdf`: per steradian. `u`: 0..1. Uniform within a cell.
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
