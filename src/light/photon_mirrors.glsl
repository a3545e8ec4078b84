#ifndef PELLUCID_LIGHT_PHOTON_MIRRORS_GLSL
#define PELLUCID_LIGHT_PHOTON_MIRRORS_GLSL

// Metals that reflect photons. Paths from a diffuse surface to such a metal leave its reflections of lights to photons.
const float kMirrorRoughness = 0.3;  // metals below this roughness reflect photons

bool reflects_photons(MaterialRecord material) {
    // reflect_photon() knows plain metal.
    bool plain = material.finish == PELLUCID_NO_FINISH && material.normal_texture == PELLUCID_NO_TEXTURE;
    return plain && material.metallic > 0.0 && material.roughness < kMirrorRoughness &&
           material.metallic_roughness_texture == PELLUCID_NO_TEXTURE && (material.flags & PELLUCID_MATERIAL_UNLIT) == 0u;
}

#endif
