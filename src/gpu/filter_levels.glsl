#ifndef PELLUCID_GPU_FILTER_LEVELS_GLSL
#define PELLUCID_GPU_FILTER_LEVELS_GLSL

// Where octahedral maps of the filtered environment lie in their image: side by side from the left. Level l is for
// perceptual roughness l / PELLUCID_FILTER_LEVELS, l = 1 .. PELLUCID_FILTER_LEVELS.

const int kFilterHalvings = 3;  // from the first level on each is half as wide as the one before, then all are alike

int filter_level_size(int level) {
    return PELLUCID_FILTER_SIZE >> min(level - 1, kFilterHalvings);
}

ivec2 filter_level_corner(int level) {
    int halved = min(level - 1, kFilterHalvings);
    int before = 2 * PELLUCID_FILTER_SIZE - (2 * PELLUCID_FILTER_SIZE >> halved);
    return ivec2(before + (level - 1 - halved) * (PELLUCID_FILTER_SIZE >> kFilterHalvings), 0);
}

// Below the last levels: what facets reflect in all, by cosine to the viewer (x) and roughness (y), both 0..1 from the
// middle of the first texel to that of the last; see tabulate_facets.comp.
const int kFacetTableSize = PELLUCID_FACET_TABLE_SIZE;
const ivec2 kFacetTableCorner = ivec2(7 * PELLUCID_FILTER_SIZE / 4, PELLUCID_FILTER_SIZE >> kFilterHalvings);

// Beside it: irradiance / pi, an octahedral map of the normal; see tabulate_irradiance.comp.
const int kIrradianceTableSize = PELLUCID_FACET_TABLE_SIZE;
const ivec2 kIrradianceTableCorner = kFacetTableCorner + ivec2(kFacetTableSize, 0);

#endif
