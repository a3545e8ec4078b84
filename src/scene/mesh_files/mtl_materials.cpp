#include "scene/mesh_files/mtl_materials.h"

#include "core/fail.h"
#include "core/image_module.h"
#include "scene/mesh_files/mtl_images.h"

#include <pellucid/image.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <utility>

namespace pellucid {
namespace {

float largest(const glm::vec3& v) { return std::max({v.x, v.y, v.z}); }

/// Reads the textures of one material.
class Textures {
public:
    Textures(const std::string& user, Scene& scene, MemoryBudget& memory, Warnings& warnings)
        : user_(user), scene_(scene), memory_(memory), warnings_(warnings) {}

    /// Without an image where it cannot be read.
    Texture read(const MtlTexture& from) {
        if (!there(from)) return {};
        return placed(from, index_of(from.file.string(), [&] { return read_scene_image(from.file, memory_); }));
    }

    /// Colour of the one texture, if it can be read, with the alpha of the other: its alpha channel, or else the mean
    /// of its colours.
    Texture read_cut_out(const MtlTexture& color, const MtlTexture& cover) {
        if (!there(cover)) return read(color);
        there(color);
        const std::string name = fmt::format("{} with alpha of {}", color.file.string(), cover.file.string());
        const int index = index_of(name, [&] {
            const auto [colors, alpha] = read_both(color, cover, 4);
            return with_alpha(colors, alpha);
        });
        return index < 0 ? read(color) : placed(color.file.empty() ? cover : color, index);
    }

    /// Normals of a bump map, whose heights or slopes its -bm multiplies.
    Texture read_bump(const MtlTexture& from) {
        if (!there(from)) return {};
        const std::string name = fmt::format("{} as bump map, -bm {}", from.file.string(), from.bump);
        return placed(from,
                      index_of(name, [&] { return normals_from_bump(read_image(from.file), from.bump, from.clamp); }));
    }

    /// Green: roughness, blue: metallic value.
    Texture read_roughness_and_metal(const MtlTexture& roughness, const MtlTexture& metal) {
        const bool rough = there(roughness), metallic = there(metal);
        if (!rough && !metallic) return {};
        const std::string name =
            fmt::format("roughness of {}, metal of {}", roughness.file.string(), metal.file.string());
        return placed(rough ? roughness : metal, index_of(name, [&] {
                          const auto [a, b] = read_both(roughness, metal, 3);
                          return roughness_and_metal(a, b);
                      }));
    }

private:
    bool there(const MtlTexture& texture) {
        if (!texture.name.empty() && texture.file.empty())
            warnings_.add(fmt::format("material {}: texture left out: {}: {}", user_, texture.name, texture.problem));
        return !texture.file.empty();
    }

    template <class Make>
    int index_of(const std::string& name, Make&& make) {
        const auto known = std::find(scene_.image_names.begin(), scene_.image_names.end(), name);
        if (known != scene_.image_names.end()) return int(known - scene_.image_names.begin());
        try {
            scene_.images.push_back(make());
        } catch (const std::exception& error) {
            memory_.check();
            warnings_.add(fmt::format("material {}: texture left out: {}", user_, error.what()));
            return -1;
        }
        scene_.image_names.push_back(name);
        return int(scene_.images.size()) - 1;
    }

    /// Two images that become one with so many channels; without a file, an empty image.
    std::pair<Image, Image> read_both(const MtlTexture& one, const MtlTexture& other, std::uint64_t channels) {
        const Image a = one.file.empty() ? Image() : read_scene_image(one.file, memory_);
        const Image b = other.file.empty() ? Image() : read_scene_image(other.file, memory_);
        const int width = std::max(a.width, b.width), height = std::max(a.height, b.height);
        if (std::int64_t(width) * height > kMaxPixels)
            fail(other.file, fmt::format("its {} x {} pixels and the {} x {} of {} make more than 2^28", b.width,
                                         b.height, a.width, a.height, one.file.string()));
        memory_.take(std::uint64_t(width) * std::uint64_t(height), channels * sizeof(float));
        return {a, b};
    }

    static Texture placed(const MtlTexture& from, int image) {
        Texture texture;
        texture.image = image;
        if (from.clamp) texture.wrap_u = texture.wrap_v = Wrap::kClamp;
        // Scaled and moved with v upwards, where a mesh's texture coordinates have it downwards: v is 1 - v.
        texture.uv_from_texcoord = glm::mat3(from.scale.x, 0.0f, 0.0f, 0.0f, from.scale.y, 0.0f, from.offset.x,
                                             1.0f - from.scale.y - from.offset.y, 1.0f);
        return texture;
    }

    const std::string& user_;
    Scene& scene_;
    MemoryBudget& memory_;
    Warnings& warnings_;
};

/// Square root of the width of the GGX lobe for a Phong exponent: alpha^2 = 2 / (Ns + 2) (Walter et al., "Microfacet
/// models for refraction through rough surfaces", EGSR 2007, section 5.2, for the equally wide Beckmann lobe).
float roughness_from_exponent(float exponent) { return std::pow(2.0f / (std::max(exponent, 0.0f) + 2.0f), 0.25f); }

glm::vec3 tint(const glm::vec3& color) { return glm::min(color, glm::vec3(1.0f)); }

/// What light has left after the glass, 0..1: the filter, or else the diffuse colour by the share d of it. Black is no
/// colour of glass, but what programs write that have none.
glm::vec3 glass_color(const MtlMaterial& from) {
    const bool blender = (from.Pr || from.Pm) && from.d.value_or(1.0f) >= 1.0f;
    if (!blender && from.Tf && largest(*from.Tf) > 0.0f) return tint(*from.Tf);
    const glm::vec3 diffuse = from.Kd && largest(*from.Kd) > 0.0f ? tint(*from.Kd) : glm::vec3(1.0f);
    return glm::mix(glm::vec3(1.0f), diffuse, std::clamp(from.d.value_or(1.0f), 0.0f, 1.0f));
}

void make_glass(const MtlMaterial& from, Material& material, Warnings& warnings) {
    material.transmission = 1.0f;
    material.thickness = 1.0f;
    material.base_color = glm::vec4(glass_color(from), 1.0f);
    material.roughness = from.Pr ? std::clamp(*from.Pr, 0.0f, 1.0f) : 0.0f;
    if (!from.Ni) {
        warnings.add(fmt::format("material {}: glass without Ni: index of refraction 1.5 used", from.name));
    } else if (*from.Ni < 1.0f || *from.Ni > 100.0f) {
        warnings.add(fmt::format("material {}: Ni {} is out of range, 1.5 used", from.name, *from.Ni));
    } else {
        material.ior = *from.Ni;
        if (material.ior == 1.0f)
            warnings.add(fmt::format("material {}: glass of Ni 1 bends no light; --ior sets another index", from.name));
    }
}

/// Matt without a highlight (illum 0 and 1, or a black Ks), else as wide as Ns says.
float opaque_roughness(const MtlMaterial& from) {
    if (from.Pr) return std::clamp(*from.Pr, 0.0f, 1.0f);
    const bool matt = (from.illum && *from.illum < 2) || (from.Ks && largest(*from.Ks) <= 0.0f) || !from.Ns;
    return matt ? 1.0f : roughness_from_exponent(*from.Ns);
}

}  // namespace

bool is_glass(const MtlMaterial& from) {
    const int illum = from.illum.value_or(2);
    // A map of d cuts out leaves and lace; what has one is no glass.
    if (!from.map_d.name.empty()) return false;
    const bool filter = from.Tf && largest(*from.Tf) > 0.0f;
    const bool see_through = from.d.value_or(1.0f)<1.0f, bends = from.Ni.value_or(1.0f)> 1.0f;
    if (illum == 4 && from.Tf == glm::vec3(1.0f) && !see_through && !bends) return false;
    if (illum == 4 || illum == 6 || illum == 7 || illum == 9) return true;
    if (see_through) return filter || bends;
    return filter && (from.Pr || from.Pm);
}

Material material_from_mtl(const MtlMaterial& from, Scene& scene, MemoryBudget& memory, Warnings& warnings) {
    Material material;
    material.name = from.name;
    Textures textures(material.name, scene, memory, warnings);
    const auto warn = [&](const std::string& what) { warnings.add(fmt::format("material {}: {}", from.name, what)); };
    const float d = std::clamp(from.d.value_or(1.0f), 0.0f, 1.0f);
    if (is_glass(from)) {
        make_glass(from, material, warnings);
        if (!from.map_Kd.name.empty()) warn("map_Kd of glass is not used");
        for (const auto& [texture, what] : {std::pair(&from.normal, "norm"), std::pair(&from.bump, "map_Bump"),
                                            std::pair(&from.map_Pr, "map_Pr"), std::pair(&from.map_Pm, "map_Pm")})
            if (!texture->name.empty()) warn(fmt::format("{} of glass is not used", what));
    } else {
        glm::vec3 color = from.Kd.value_or(glm::vec3(0.8f));
        // Programs write a black Kd beside a texture that they mean to be seen.
        if (!from.map_Kd.name.empty() && largest(color) <= 0.0f) color = glm::vec3(1.0f);
        material.roughness = opaque_roughness(from);
        const int illum = from.illum.value_or(2);
        const bool mirror = illum == 3 || illum == 5 || illum == 8;
        const glm::vec3 specular = from.Ks.value_or(glm::vec3(0.0f));
        if (from.Pm) {
            material.metallic = std::clamp(*from.Pm, 0.0f, 1.0f);
        } else if (mirror && largest(specular) >= 0.5f && largest(specular) > largest(color)) {
            material.metallic = 1.0f;
            color = specular;
        }
        material.base_color = glm::vec4(tint(color), 1.0f);
        if (from.map_d.name.empty()) {
            material.base_color_texture = textures.read(from.map_Kd);
        } else {
            material.base_color_texture = textures.read_cut_out(from.map_Kd, from.map_d);
            if (!from.map_d.file.empty()) material.alpha_cutoff = 0.5f;
        }
        if (!from.normal.name.empty() || from.bump.name.empty()) {
            material.normal_texture = textures.read(from.normal);
        } else {
            material.normal_texture = textures.read_bump(from.bump);
        }
        material.metallic_roughness_texture = textures.read_roughness_and_metal(from.map_Pr, from.map_Pm);
        if (material.metallic_roughness_texture.image >= 0) {  // the maps stand for the numbers
            if (!from.map_Pr.file.empty()) material.roughness = 1.0f;
            if (!from.map_Pm.file.empty()) material.metallic = 1.0f;
        }
        if (from.map_d.name.empty() && d < 1.0f) {
            material.base_color.a = d;
            material.alpha_is_coverage = true;
        }
    }
    material.emission = from.Ke.value_or(glm::vec3(0.0f));
    if (!from.map_Ke.name.empty()) {
        material.emission_texture = textures.read(from.map_Ke);
        const bool shown = material.emission_texture.image >= 0;
        if (shown && largest(material.emission) <= 0.0f) material.emission = glm::vec3(1.0f);
    }
    std::vector<std::string> unused = from.unused;
    if (!unused.empty()) warn(fmt::format("{} not used", fmt::join(unused, ", ")));
    return material;
}

}  // namespace pellucid
