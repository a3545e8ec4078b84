// Materials, textures and samplers of glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021, sections 3.8, 3.9) with the
// KHR_materials extensions, from materials as MaterialReader reads them.
#include "scene/write/gltf_materials_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace pellucid {
namespace {

using nlohmann::json;

json numbers(const glm::vec3& v) { return {v.x, v.y, v.z}; }

class MaterialWriter {
public:
    explicit MaterialWriter(std::vector<std::string>& left_out) : left_out_(left_out) {}

    void add(const Material& material) {
        material_ = &material;
        json to{{"name", material.name}, {"doubleSided", material.double_sided}};
        write_base(to);
        write_emission(to);
        write_alpha(to);
        if (material.unlit) to["extensions"]["KHR_materials_unlit"] = json::object();
        write_glass(to);
        if (!material.finish.plain()) write_finish(to);
        all_.materials.push_back(std::move(to));
    }
    GltfMaterialsJson take() { return std::move(all_); }

private:
    void write_base(json& to) {
        const Material& m = *material_;
        json& pbr = to["pbrMetallicRoughness"];
        pbr = {{"baseColorFactor", {m.base_color.r, m.base_color.g, m.base_color.b, m.base_color.a}},
               {"metallicFactor", m.metallic},
               {"roughnessFactor", m.roughness}};
        add_texture(pbr, "baseColorTexture", m.base_color_texture);
        add_texture(pbr, "metallicRoughnessTexture", m.metallic_roughness_texture);
        add_texture(to, "normalTexture", m.normal_texture, {{"scale", m.normal_scale}});
        add_texture(to, "occlusionTexture", m.occlusion_texture, {{"strength", m.occlusion_strength}});
    }

    void write_emission(json& to) {
        const glm::vec3 emission = material_->emission;
        const float strength = std::max({emission.r, emission.g, emission.b, 1.0f});
        if (emission == glm::vec3(0.0f)) return;
        to["emissiveFactor"] = numbers(emission / strength);
        if (strength > 1.0f) to["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
        add_texture(to, "emissiveTexture", material_->emission_texture);
    }

    void write_alpha(json& to) {
        if (material_->alpha_cutoff > 0.0f) {
            to["alphaMode"] = "MASK";
            to["alphaCutoff"] = material_->alpha_cutoff;
        } else if (material_->alpha_is_coverage) {
            to["alphaMode"] = "BLEND";
        }
    }

    void write_glass(json& to) {
        const Material& m = *material_;
        if (m.transmissive()) {
            json& transmission = to["extensions"]["KHR_materials_transmission"];
            transmission["transmissionFactor"] = m.transmission;
            add_texture(transmission, "transmissionTexture", m.transmission_texture);
        }
        if (m.ior != 1.5f) to["extensions"]["KHR_materials_ior"]["ior"] = m.ior;
        if (m.dispersion > 0.0f) to["extensions"]["KHR_materials_dispersion"]["dispersion"] = m.dispersion;
        const bool attenuates = std::isfinite(m.attenuation_distance);
        if (m.thickness > 0.0f || attenuates) {
            json& volume = to["extensions"]["KHR_materials_volume"];
            volume["thicknessFactor"] = m.thickness;
            volume["attenuationColor"] = numbers(m.attenuation_color);
            if (attenuates) volume["attenuationDistance"] = m.attenuation_distance;
        }
        if (m.diffuse_transmission > 0.0f)
            to["extensions"]["KHR_materials_diffuse_transmission"] = {
                {"diffuseTransmissionFactor", m.diffuse_transmission},
                {"diffuseTransmissionColorFactor", numbers(m.diffuse_transmission_color)}};
    }

    void write_finish(json& to) {
        const Finish& f = material_->finish;
        json& extensions = to["extensions"];
        if (f.coated()) {
            json& coat = extensions["KHR_materials_clearcoat"];
            coat = {{"clearcoatFactor", f.clearcoat}, {"clearcoatRoughnessFactor", f.clearcoat_roughness}};
            add_texture(coat, "clearcoatTexture", f.clearcoat_texture);
            add_texture(coat, "clearcoatRoughnessTexture", f.clearcoat_roughness_texture);
            add_texture(coat, "clearcoatNormalTexture", f.clearcoat_normal_texture,
                        {{"scale", f.clearcoat_normal_scale}});
        }
        if (f.has_sheen()) {
            json& sheen = extensions["KHR_materials_sheen"];
            sheen = {{"sheenColorFactor", numbers(f.sheen_color)}, {"sheenRoughnessFactor", f.sheen_roughness}};
            add_texture(sheen, "sheenColorTexture", f.sheen_color_texture);
            add_texture(sheen, "sheenRoughnessTexture", f.sheen_roughness_texture);
        }
        json& specular = extensions["KHR_materials_specular"];
        specular = {{"specularFactor", f.specular}, {"specularColorFactor", numbers(f.specular_color)}};
        add_texture(specular, "specularTexture", f.specular_texture);
        add_texture(specular, "specularColorTexture", f.specular_color_texture);
        if (f.iridescence > 0.0f) {
            json& film = extensions["KHR_materials_iridescence"];
            film = {{"iridescenceFactor", f.iridescence},
                    {"iridescenceIor", f.film_ior},
                    {"iridescenceThicknessMinimum", f.film_thinnest_nm},
                    {"iridescenceThicknessMaximum", f.film_thickest_nm}};
            add_texture(film, "iridescenceTexture", f.iridescence_texture);
            add_texture(film, "iridescenceThicknessTexture", f.film_thickness_texture);
        }
        if (f.anisotropy > 0.0f) {
            json& along = extensions["KHR_materials_anisotropy"];
            along = {{"anisotropyStrength", f.anisotropy}, {"anisotropyRotation", f.anisotropy_rotation}};
            add_texture(along, "anisotropyTexture", f.anisotropy_texture);
        }
    }

    void add_texture(json& to, const char* key, const Texture& texture, const json& more = json::object()) {
        if (texture.image < 0) return;
        json& info = to[key] = more;
        info["index"] = texture_of(texture);
        info["texCoord"] = texture.texcoord_set;
        if (texture.uv_from_texcoord != glm::mat3(1.0f))
            info["extensions"]["KHR_texture_transform"] = transform(texture.uv_from_texcoord);
    }

    std::size_t texture_of(const Texture& texture) {
        constexpr int kNearest = 9728, kLinear = 9729;
        const auto wrap = [](Wrap w) { return w == Wrap::kRepeat ? 10497 : w == Wrap::kMirror ? 33648 : 33071; };
        const std::size_t sampler = index_in(all_.samplers, {{"wrapS", wrap(texture.wrap_u)},
                                                             {"wrapT", wrap(texture.wrap_v)},
                                                             {"magFilter", texture.nearest ? kNearest : kLinear}});
        return index_in(all_.textures, {{"source", texture.image}, {"sampler", sampler}});
    }

    static std::size_t index_in(json& array, const json& value) {
        const auto found = std::find(array.begin(), array.end(), value);
        const auto index = std::size_t(found - array.begin());
        if (found == array.end()) array.push_back(value);
        return index;
    }

    /// Translation, rotation and scale whose product the matrix is, as KHR_texture_transform composes them.
    json transform(const glm::mat3& m) {
        const float angle = std::atan2(-m[0][1], m[0][0]);
        const float c = std::cos(angle), s = std::sin(angle);
        const glm::vec2 scale(std::hypot(m[0][0], m[0][1]), s * m[1][0] + c * m[1][1]);
        const float shear = c * m[1][0] - s * m[1][1];
        if (std::abs(shear) > 1e-5f * (scale.x + std::abs(scale.y)))
            left_out_.push_back(fmt::format("{}: shear of a texture left out", material_->name));
        return {{"offset", {m[2][0], m[2][1]}}, {"rotation", angle}, {"scale", {scale.x, scale.y}}};
    }

    std::vector<std::string>& left_out_;
    const Material* material_ = nullptr;  ///< at hand
    GltfMaterialsJson all_;
};

}  // namespace

GltfMaterialsJson gltf_materials_json(const Scene& scene, std::vector<std::string>& left_out) {
    MaterialWriter writer(left_out);
    for (const Material& material : scene.materials) writer.add(material);
    return writer.take();
}

}  // namespace pellucid
