#pragma once

#include <pellucid/scene.h>

#include <array>

namespace pellucid {

/// Every texture of a material, always in the same order.
inline std::array<const Texture*, 16> textures_of(const Material& m) {
    const Finish& f = m.finish;
    return {
        &m.base_color_texture,       &m.emission_texture,    &m.transmission_texture,    &m.metallic_roughness_texture,
        &m.normal_texture,           &m.occlusion_texture,   &f.clearcoat_texture,       &f.clearcoat_roughness_texture,
        &f.clearcoat_normal_texture, &f.sheen_color_texture, &f.sheen_roughness_texture, &f.specular_texture,
        &f.specular_color_texture,   &f.iridescence_texture, &f.film_thickness_texture,  &f.anisotropy_texture};
}

}  // namespace pellucid
