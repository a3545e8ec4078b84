#pragma once

#include <pellucid/scene.h>

#include <array>
#include <cstddef>

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

inline std::array<Texture*, 16> mutable_textures_of(Material& material) {
    std::array<Texture*, 16> textures;
    const auto constant = textures_of(static_cast<const Material&>(material));
    for (std::size_t i = 0; i < textures.size(); ++i) textures[i] = const_cast<Texture*>(constant[i]);
    return textures;
}

}  // namespace pellucid
