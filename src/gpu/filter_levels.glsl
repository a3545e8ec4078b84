#ifndef PELLUCID_GPU_FILTER_LEVELS_GLSL
#define PELLUCID_GPU_FILTER_LEVELS_GLSL

// Layout of the image of the filtered environment. Octahedral maps lie side by side from the left. Level l is for
// perceptual roughness l / PELLUCID_FILTER_LEVELS, l = 1 .. PELLUCID_FILTER_LEVELS.

const int kFilterHalvings = 3;  // this many levels after the first halve the width; later levels keep it

int filter_level_size(int level) {
    return PELLUCID_FILTER_SIZE >> min(level - 1, kFilterHalvings);
}

ivec2 filter_level_corner(int level) {
    int halved = min(level - 1, kFilterHalvings);
    int before = 2 * PELLUCID_FILTER_SIZE - (2 * PELLUCID_FILTER_SIZE >> halved);
    return ivec2(before + (level - 1 - halved) * (PELLUCID_FILTER_SIZE >> kFilterHalvings), 0);
}

// A table below the last levels holds the total reflection of facets; see tabulate_facets.comp. x is the cosine to the
// viewer, y the roughness. Both go from 0 at the centre of the first texel to 1 at that of the last.
const int kFacetTableSize = PELLUCID_FACET_TABLE_SIZE;
const ivec2 kFacetTableCorner = ivec2(7 * PELLUCID_FILTER_SIZE / 4, PELLUCID_FILTER_SIZE >> kFilterHalvings);

// The next table holds irradiance / pi as an octahedral map of the normal; see tabulate_irradiance.comp.
const int kIrradianceTableSize = PELLUCID_FACET_TABLE_SIZE;
const ivec2 kIrradianceTableCorner = kFacetTableCorner + ivec2(kFacetTableSize, 0);

#endif
