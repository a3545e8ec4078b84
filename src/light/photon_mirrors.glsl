#ifndef PELLUCID_LIGHT_PHOTON_MIRRORS_GLSL
#define PELLUCID_LIGHT_PHOTON_MIRRORS_GLSL

// Metal that photons are reflected by. Paths that come to it from a diffuse surface leave its highlights of lights to photons.
const float kMirrorRoughness = 0.3;  // photons follow metal below

bool reflects_photons(MaterialRecord material) {
    return material.metallic > 0.0 && material.roughness < kMirrorRoughness &&
           material.metallic_roughness_texture == PELLUCID_NO_TEXTURE && (material.flags & PELLUCID_MATERIAL_UNLIT) == 0u;
}

#endif
