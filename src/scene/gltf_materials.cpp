#include "scene/gltf_materials.h"

#include "core/fail.h"
#include "core/math.h"
#include "scene/gltf_properties.h"
#include "scene/gltf_spec_gloss.h"
#include "scene/gltf_textures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pellucid {
namespace {

class MaterialReader {
public:
    MaterialReader(const GltfFile& gltf, GltfTextures& textures, Warnings& warnings)
        : gltf_(gltf), textures_(textures), specular_glossiness_(gltf, textures, warnings), warnings_(warnings) {}

    Material read(const tinygltf::Material& from, std::size_t number) {
        Material material;
        material.name = from.name.empty() ? fmt::format("material {}", number) : from.name;
        user_ = fmt::format("material {}", material.name);
        if (from.name.empty()) user_ = material.name;
        textures_.begin(number, user_);
        if (!specular_glossiness_.read(from, user_, material)) read_base(from.pbrMetallicRoughness, material);
        read_surface(from, material);
        read_glass(from.extensions, material);
        read_alpha(from, material);
        read_diffuse_transmission(from.extensions, material);
        read_directions(from, material);
        read_finish(from.extensions, material);
        if (material.transmissive() && textures_.lacks_basis())
            fail(gltf_.path, fmt::format("{}: glass with a texture of KTX2 (KHR_texture_basisu), which is not decoded; "
                                         "export the file with PNG or JPEG images",
                                         user_));
        return material;
    }

    void warn_about_leftovers() {
        specular_glossiness_.warn_about_conversions();
        textures_.warn_about_leftovers();
    }

private:
    /// `value` if it lies in the range that the specification gives, else the nearest that does.
    float in_range(double value, double low, double high, const char* what) {
        if (value >= low && value <= high) return static_cast<float>(value);
        const double used = value > high ? high : low;
        warnings_.add(fmt::format("{}: {} {} is out of range, {} used", user_, what, value, used));
        return static_cast<float>(used);
    }

    void read_base(const tinygltf::PbrMetallicRoughness& pbr, Material& material) {
        for (int k = 0; k < 4 && pbr.baseColorFactor.size() == 4; ++k)
            material.base_color[k] = in_range(pbr.baseColorFactor[std::size_t(k)], 0.0, 1.0, "baseColorFactor");
        material.base_color_texture = texture(pbr.baseColorTexture, "base colour");
        material.metallic = in_range(pbr.metallicFactor, 0.0, 1.0, "metallicFactor");
        material.roughness = in_range(pbr.roughnessFactor, 0.0, 1.0, "roughnessFactor");
        material.metallic_roughness_texture = texture(pbr.metallicRoughnessTexture, "metallic-roughness");
    }

    void read_surface(const tinygltf::Material& from, Material& material) {
        constexpr double kBrightest = 1e6;
        const double strength =
            in_range(GltfProperties(from.extensions, "KHR_materials_emissive_strength").number("emissiveStrength", 1.0),
                     0.0, kBrightest, "emissiveStrength");
        for (int k = 0; k < 3 && from.emissiveFactor.size() == 3; ++k)
            material.emission[k] = static_cast<float>(
                strength * double(in_range(from.emissiveFactor[std::size_t(k)], 0.0, kBrightest, "emissiveFactor")));
        if (material.emission != glm::vec3(0.0f)) material.emission_texture = texture(from.emissiveTexture, "emission");
        material.unlit = GltfProperties(from.extensions, "KHR_materials_unlit").present();
        material.double_sided = from.doubleSided;
    }

    void read_alpha(const tinygltf::Material& from, Material& material) {
        if (from.alphaMode == "MASK") {
            // A cutoff of 0 keeps every fragment; the largest alpha is 1.
            material.alpha_cutoff = in_range(from.alphaCutoff, 0.0, 2.0, "alphaCutoff");
        } else if (from.alphaMode == "BLEND" && material.transmissive()) {
            // Alpha is coverage, transmission is glass: files of glass often have both, and a low alpha.
            material.alpha_is_coverage = !material.refractive();
            if (material.alpha_is_coverage) return;
            if (material.base_color.a < 1.0f || material.base_color_texture.image >= 0)
                warnings_.add(fmt::format("{}: alpha is left out, solid glass is drawn at full coverage", user_));
        } else if (from.alphaMode == "BLEND") {
            material.alpha_is_coverage = true;
        }
    }

    void read_diffuse_transmission(const tinygltf::ExtensionMap& extensions, Material& material) {
        const GltfProperties diffuse(extensions, "KHR_materials_diffuse_transmission");
        material.diffuse_transmission =
            in_range(diffuse.number("diffuseTransmissionFactor", 0.0), 0.0, 1.0, "diffuseTransmissionFactor");
        for (int k = 0; k < 3; ++k)
            material.diffuse_transmission_color[k] = in_range(diffuse.number("diffuseTransmissionColorFactor", k, 1.0),
                                                              0.0, 1.0, "diffuseTransmissionColorFactor");
        for (const char* name : {"diffuseTransmissionTexture", "diffuseTransmissionColorTexture"}) {
            const int index = diffuse.texture(name).index;
            if (index < 0) continue;
            textures_.expect(index);
            warnings_.add(fmt::format("{}: {} is not used", user_, name));
        }
        // Light that goes straight through leaves no share to be scattered; glass with a little of both is drawn as glass.
        if (material.diffuse_transmission > 0.0f && material.transmissive())
            warnings_.add(fmt::format("{}: diffuse transmission of glass is not drawn", user_));
    }

    void read_glass(const tinygltf::ExtensionMap& extensions, Material& material) {
        const GltfProperties transmission(extensions, "KHR_materials_transmission");
        material.transmission =
            in_range(transmission.number("transmissionFactor", 0.0), 0.0, 1.0, "transmissionFactor");
        if (material.transmission > 0.0f)
            material.transmission_texture = texture(transmission.texture("transmissionTexture"), "transmission");

        const double ior = GltfProperties(extensions, "KHR_materials_ior").number("ior", 1.5);
        // The extension lets 0 stand for an infinite index: a mirror. Glass has none.
        material.ior = ior == 0.0 ? 1.5f : in_range(ior, 1.0, 100.0, "ior");
        if (ior == 0.0) warnings_.add(fmt::format("{}: ior 0 (infinite) is not supported, 1.5 used", user_));
        material.dispersion = in_range(GltfProperties(extensions, "KHR_materials_dispersion").number("dispersion", 0.0),
                                       0.0, 100.0, "dispersion");

        // thicknessTexture is for renderers that do not follow light through the solid.
        const GltfProperties volume(extensions, "KHR_materials_volume");
        constexpr double kHuge = std::numeric_limits<float>::max();
        material.thickness = in_range(volume.number("thicknessFactor", 0.0), 0.0, kHuge, "thicknessFactor");
        for (int k = 0; k < 3; ++k)
            material.attenuation_color[k] =
                in_range(volume.number("attenuationColor", k, 1.0), 0.0, 1.0, "attenuationColor");
        const double distance = volume.number("attenuationDistance", std::numeric_limits<double>::infinity());
        if (!std::isinf(distance))
            material.attenuation_distance = in_range(distance, 1e-6, kHuge, "attenuationDistance");
    }

    Texture texture(const tinygltf::TextureInfo& info, const char* what) { return textures_.texture(info, what); }

    /// Textures of normals and occlusion.
    void read_directions(const tinygltf::Material& from, Material& material) {
        constexpr double kFar = 1e6;
        const auto read = [&](const auto& given, const char* what) {
            tinygltf::TextureInfo info;
            info.index = given.index;
            info.texCoord = given.texCoord;
            info.extensions = given.extensions;
            return texture(info, what);
        };
        if (material.unlit) return;
        material.normal_texture = read(from.normalTexture, "normal");
        material.normal_scale = in_range(from.normalTexture.scale, -kFar, kFar, "scale of the normal texture");
        if (material.transmissive()) return;
        material.occlusion_texture = read(from.occlusionTexture, "occlusion");
        material.occlusion_strength =
            in_range(from.occlusionTexture.strength, 0.0, 1.0, "strength of the occlusion texture");
    }

    /// What extensions add to opaque surfaces.
    void read_finish(const tinygltf::ExtensionMap& extensions, Material& material) {
        if (material.unlit) return;
        const GltfProperties coat(extensions, "KHR_materials_clearcoat"), sheen(extensions, "KHR_materials_sheen");
        const GltfProperties specular(extensions, "KHR_materials_specular"),
            film(extensions, "KHR_materials_iridescence");
        const GltfProperties along(extensions, "KHR_materials_anisotropy");
        if (material.transmissive()) {
            // Thin-walled and solid glass have smooth boundaries of their index alone.
            std::vector<const char*> left_out;
            if (coat.number("clearcoatFactor", 0.0) > 0.0) left_out.push_back("clearcoat");
            if (changes(specular)) left_out.push_back("specular");
            for (int k = 0; k < 3; ++k)
                if (sheen.number("sheenColorFactor", k, 0.0) > 0.0) {
                    left_out.push_back("sheen");
                    break;
                }
            if (film.number("iridescenceFactor", 0.0) > 0.0) left_out.push_back("iridescence");
            if (along.number("anisotropyStrength", 0.0) > 0.0) left_out.push_back("anisotropy");
            if (!left_out.empty())
                warnings_.add(fmt::format("{}: {} of glass left out", user_, fmt::join(left_out, " and ")));
            return;
        }
        Finish& finish = material.finish;
        read_coat(coat, finish);
        read_sheen(sheen, finish);
        read_specular(specular, finish);
        read_film(film, finish);
        finish.anisotropy = factor(along, "anisotropyStrength", 0.0);
        if (finish.anisotropy > 0.0f) {
            finish.anisotropy_rotation =
                in_range(along.number("anisotropyRotation", 0.0), -1e6, 1e6, "anisotropyRotation");
            finish.anisotropy_texture = texture(along.texture("anisotropyTexture"), "anisotropy");
        }
    }

    static bool changes(const GltfProperties& specular) {
        bool changes = specular.number("specularFactor", 1.0) != 1.0 ||
                       specular.texture("specularTexture").index >= 0 ||
                       specular.texture("specularColorTexture").index >= 0;
        for (int k = 0; k < 3; ++k) changes = changes || specular.number("specularColorFactor", k, 1.0) != 1.0;
        return changes;
    }

    float factor(const GltfProperties& from, const char* key, double otherwise) {
        return in_range(from.number(key, otherwise), 0.0, 1.0, key);
    }

    void read_coat(const GltfProperties& coat, Finish& finish) {
        finish.clearcoat = factor(coat, "clearcoatFactor", 0.0);
        if (!finish.coated()) return;
        finish.clearcoat_texture = texture(coat.texture("clearcoatTexture"), "clearcoat");
        finish.clearcoat_roughness = factor(coat, "clearcoatRoughnessFactor", 0.0);
        finish.clearcoat_roughness_texture = texture(coat.texture("clearcoatRoughnessTexture"), "clearcoat roughness");
        finish.clearcoat_normal_texture = texture(coat.texture("clearcoatNormalTexture"), "clearcoat normal");
        finish.clearcoat_normal_scale = in_range(coat.texture_number("clearcoatNormalTexture", "scale", 1.0), -1e6, 1e6,
                                                 "scale of the clearcoat normal texture");
    }

    void read_sheen(const GltfProperties& sheen, Finish& finish) {
        for (int k = 0; k < 3; ++k)
            finish.sheen_color[k] = in_range(sheen.number("sheenColorFactor", k, 0.0), 0.0, 1.0, "sheenColorFactor");
        if (!finish.has_sheen()) return;
        finish.sheen_color_texture = texture(sheen.texture("sheenColorTexture"), "sheen colour");
        finish.sheen_roughness = factor(sheen, "sheenRoughnessFactor", 0.0);
        finish.sheen_roughness_texture = texture(sheen.texture("sheenRoughnessTexture"), "sheen roughness");
    }

    void read_specular(const GltfProperties& specular, Finish& finish) {
        finish.specular = factor(specular, "specularFactor", 1.0);
        finish.specular_texture = texture(specular.texture("specularTexture"), "specular");
        for (int k = 0; k < 3; ++k)
            finish.specular_color[k] =
                in_range(specular.number("specularColorFactor", k, 1.0), 0.0, 1e6, "specularColorFactor");
        finish.specular_color_texture = texture(specular.texture("specularColorTexture"), "specular colour");
    }

    void read_film(const GltfProperties& film, Finish& finish) {
        finish.iridescence = factor(film, "iridescenceFactor", 0.0);
        if (finish.iridescence == 0.0f) return;
        constexpr double kThickest = 1e6;  // nm
        const auto thickness = [&](const char* key, double otherwise) {
            return in_range(film.number(key, otherwise), 0.0, kThickest, key);
        };
        finish.iridescence_texture = texture(film.texture("iridescenceTexture"), "iridescence");
        finish.film_ior = in_range(film.number("iridescenceIor", 1.3), 1.0, 100.0, "iridescenceIor");
        finish.film_thinnest_nm = thickness("iridescenceThicknessMinimum", 100.0);
        finish.film_thickest_nm = thickness("iridescenceThicknessMaximum", 400.0);
        finish.film_thickness_texture = texture(film.texture("iridescenceThicknessTexture"), "iridescence thickness");
    }

    const GltfFile& gltf_;
    GltfTextures& textures_;
    SpecularGlossiness specular_glossiness_;
    Warnings& warnings_;
    std::string user_;  ///< the material at hand, for messages
};

}  // namespace

std::vector<TexcoordSets> read_gltf_materials(const GltfFile& gltf, Scene& scene, Warnings& warnings) {
    const auto& materials = gltf.model.materials;
    GltfTextures textures(gltf, scene, warnings);
    Warnings unheard;
    MaterialReader first(gltf, textures, unheard);
    for (std::size_t i = 0; i < materials.size(); ++i) first.read(materials[i], i);
    textures.begin_again();
    MaterialReader second(gltf, textures, warnings);
    for (std::size_t i = 0; i < materials.size(); ++i) scene.materials.push_back(second.read(materials[i], i));
    second.warn_about_leftovers();
    return textures.sets();
}

Material default_gltf_material() {
    Material material;
    material.name = "default";
    material.metallic = 1.0f;
    material.roughness = 1.0f;
    material.double_sided = false;
    return material;
}

}  // namespace pellucid
