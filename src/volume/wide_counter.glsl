#ifndef PELLUCID_VOLUME_WIDE_COUNTER_GLSL
#define PELLUCID_VOLUME_WIDE_COUNTER_GLSL

// 64-bit fixed-point sums in two words each, the lower first. They need no 64-bit integers, and do not depend on the
// order of additions.

// Converts an amount in units of the counter, >= 0, to two words.
uvec2 fixed_point(float units) {
    float high = floor(units / 4294967296.0);
    return uvec2(uint(min(units - high * 4294967296.0, 4294967040.0)), uint(high));
}

// Adds an amount of two words to counter i in an array of words.
#define PELLUCID_ADD_WIDE(words, i, amount)                                     \
    {                                                                           \
        uint before_ = atomicAdd(words[2u * (i)], amount.x);                    \
        uint carry_ = amount.y + (before_ + amount.x < before_ ? 1u : 0u);      \
        if (carry_ > 0u) atomicAdd(words[2u * (i) + 1u], carry_);               \
    }

float wide_value(uint low, uint high) { return float(low) + 4294967296.0 * float(high); }

#endif
