#include "gpu/material_records.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

/// All of it but textures.
void fill_record(const Material& material, gpu::MaterialRecord& record) {
    record.base_color = material.base_color;
    record.emission = glm::vec4(material.emission, 0.0f);
    record.sigma_a = glm::vec4(material.sigma_a(), material.thickness);
    record.ior = material.ior;
    record.transmission = material.transmission;
    record.alpha_cutoff = material.alpha_cutoff;
    record.flags = (material.unlit ? PELLUCID_MATERIAL_UNLIT : 0u) |
                   (material.alpha_is_coverage ? PELLUCID_MATERIAL_COVERAGE : 0u) |
                   (material.single_sided() ? PELLUCID_MATERIAL_SINGLE_SIDED : 0u);
    record.metallic = material.metallic;
    record.roughness = material.roughness;
    record.normal_scale = material.normal_scale;
    record.occlusion_strength = material.occlusion_strength;
    record.dispersion = material.dispersion;
    record.translucent = 0;
    record.diffuse_transmission = glm::vec4(0.0f);
    if (material.translucent()) {
        const float share = material.diffuse_transmission;
        record.translucent = 1;
        record.diffuse_transmission = glm::vec4(share * material.diffuse_transmission_color, 0.0f);
        record.base_color = glm::vec4((1.0f - share) * glm::vec3(material.base_color), material.base_color.a);
    }
}

/// All of it but textures.
void fill_finish(const Finish& finish, gpu::FinishRecord& record) {
    record.sheen = glm::vec4(finish.sheen_color, finish.sheen_roughness);
    record.specular = glm::vec4(finish.specular_color, finish.specular);
    record.clearcoat = finish.clearcoat;
    record.clearcoat_roughness = finish.clearcoat_roughness;
    record.clearcoat_normal_scale = finish.clearcoat_normal_scale;
    record.iridescence = finish.iridescence;
    record.film_ior = finish.film_ior;
    record.film_thinnest_nm = finish.film_thinnest_nm;
    record.film_thickest_nm = finish.film_thickest_nm;
    record.anisotropy = finish.anisotropy;
    record.anisotropy_cosine = std::cos(finish.anisotropy_rotation);
    record.anisotropy_sine = std::sin(finish.anisotropy_rotation);
}

/// Octahedral, as octahedral.glsl has it, with the sign of w in the last bit; 0 for a zero vector.
std::uint32_t pack_tangent(const glm::vec4& tangent) {
    const glm::vec3 t(tangent);
    const float sum = std::abs(t.x) + std::abs(t.y) + std::abs(t.z);
    if (!(sum > 0.0f)) return 0;
    glm::vec2 p = glm::vec2(t) / sum;
    if (t.z < 0.0f)
        p = {(1.0f - std::abs(p.y)) * (p.x < 0.0f ? -1.0f : 1.0f),
             (1.0f - std::abs(p.x)) * (p.y < 0.0f ? -1.0f : 1.0f)};
    const std::uint32_t packed = (glm::packSnorm2x16(p) & ~1u) | (tangent.w > 0.0f ? 1u : 0u);
    return packed != 0 ? packed : 2u;
}

}  // namespace

gpu::MaterialRecord textured_record(const Material& material, TextureTable& textures) {
    gpu::MaterialRecord record{};
    record.base_color_texture = textures.add(material.base_color_texture, true);
    record.emission_texture = textures.add(material.emission_texture, true);
    record.transmission_texture = textures.add(material.transmission_texture, false);
    record.metallic_roughness_texture = textures.add(material.metallic_roughness_texture, false);
    record.normal_texture = textures.add(material.normal_texture, false);
    record.occlusion_texture = textures.add(material.occlusion_texture, false);
    return record;
}

gpu::FinishRecord textured_finish(const Finish& finish, TextureTable& textures) {
    gpu::FinishRecord record{};
    record.clearcoat_texture = textures.add(finish.clearcoat_texture, false);
    record.clearcoat_roughness_texture = textures.add(finish.clearcoat_roughness_texture, false);
    record.clearcoat_normal_texture = textures.add(finish.clearcoat_normal_texture, false);
    record.sheen_color_texture = textures.add(finish.sheen_color_texture, true);
    record.sheen_roughness_texture = textures.add(finish.sheen_roughness_texture, false);
    record.specular_texture = textures.add(finish.specular_texture, false);
    record.specular_color_texture = textures.add(finish.specular_color_texture, true);
    record.iridescence_texture = textures.add(finish.iridescence_texture, false);
    record.film_thickness_texture = textures.add(finish.film_thickness_texture, false);
    record.anisotropy_texture = textures.add(finish.anisotropy_texture, false);
    return record;
}

void update_records(const Material& material, std::size_t number, gpu::MaterialRecord& record,
                    gpu::FinishRecord& finish) {
    fill_record(material, record);
    fill_finish(material.finish, finish);
    record.finish = material.finish.plain() ? PELLUCID_NO_FINISH : std::uint32_t(number);
}

bool has_finish(const Material& material) {
    return !material.finish.plain() || material.normal_texture.image >= 0 || material.occlusion_texture.image >= 0;
}

std::vector<std::uint32_t> packed_tangents(const Scene& scene) {
    std::vector<std::uint32_t> packed;
    const auto has_some = [](const Mesh& mesh) { return !mesh.tangents.empty(); };
    if (std::none_of(scene.meshes.begin(), scene.meshes.end(), has_some)) return {0};  // something has to be bound
    for (const Mesh& mesh : scene.meshes) {
        if (mesh.tangents.empty()) packed.insert(packed.end(), mesh.positions.size(), 0u);
        for (const glm::vec4& tangent : mesh.tangents) packed.push_back(pack_tangent(tangent));
    }
    return packed;
}

}  // namespace pellucid
