// KHR_materials_pbrSpecularGlossiness (Khronos Group, glTF extensions/2.0/Archived, 2017), converted as in the
// registry's example "convert-between-workflows": the metallic value is what gives the same reflection and the same
// diffuse colour, where dielectrics reflect 0.04.
#include "scene/gltf_spec_gloss.h"

#include "core/image_module.h"
#include "core/srgb.h"
#include "scene/gltf_properties.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pellucid {
namespace {

constexpr const char* kSpecularGlossiness = "KHR_materials_pbrSpecularGlossiness";
constexpr float kDielectric = 0.04f;

struct MetalRough {
    glm::vec3 base_color;
    float metallic;
};

float brightness(const glm::vec3& c) { return std::sqrt(0.299f * c.r * c.r + 0.587f * c.g * c.g + 0.114f * c.b * c.b); }

MetalRough convert(const glm::vec3& diffuse, const glm::vec3& specular) {
    constexpr float kLeast = 1e-6f;
    const float rest = 1.0f - std::max({specular.r, specular.g, specular.b});
    const float d = brightness(diffuse), s = brightness(specular);
    float metallic = 0.0f;
    if (s >= kDielectric) {
        const float b = d * rest / (1.0f - kDielectric) + s - 2.0f * kDielectric;
        const float root = std::sqrt(std::max(b * b - 4.0f * kDielectric * (kDielectric - s), 0.0f));
        metallic = std::clamp((root - b) / (2.0f * kDielectric), 0.0f, 1.0f);
    }
    const glm::vec3 from_diffuse = diffuse * (rest / (1.0f - kDielectric) / std::max(1.0f - metallic, kLeast));
    const glm::vec3 from_specular = (specular - kDielectric * (1.0f - metallic)) / std::max(metallic, kLeast);
    const float share = metallic * metallic;
    return {glm::clamp(from_diffuse * (1.0f - share) + from_specular * share, 0.0f, 1.0f), metallic};
}

glm::vec4 texel(const Image& image, int x, int y) {
    const float* const t = image.at(std::clamp(x, 0, image.width - 1), std::clamp(y, 0, image.height - 1));
    if (image.channels >= 3) return {t[0], t[1], t[2], image.channels > 3 ? t[3] : 1.0f};
    return {t[0], t[0], t[0], image.channels > 1 ? t[1] : 1.0f};
}

/// The middle of texel (x, y) of an image of another size, interpolated; its colour is decoded.
glm::vec4 linear_texel(const Image& image, int x, int y, int width, int height) {
    const float u = (float(x) + 0.5f) * float(image.width) / float(width) - 0.5f;
    const float v = (float(y) + 0.5f) * float(image.height) / float(height) - 0.5f;
    const int x0 = int(std::floor(u)), y0 = int(std::floor(v));
    const float fx = u - float(x0), fy = v - float(y0);
    const glm::vec4 top = glm::mix(texel(image, x0, y0), texel(image, x0 + 1, y0), fx);
    const glm::vec4 bottom = glm::mix(texel(image, x0, y0 + 1), texel(image, x0 + 1, y0 + 1), fx);
    const glm::vec4 c = glm::mix(top, bottom, fy);
    return {linear_from_srgb(c.r), linear_from_srgb(c.g), linear_from_srgb(c.b), c.a};
}

Image mean_texel(const Image& image) {
    glm::dvec4 sum(0.0);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) sum += glm::dvec4(texel(image, x, y));
    Image mean(1, 1, 4);
    for (int k = 0; k < 4; ++k) mean.pixels[std::size_t(k)] = float(sum[k] / (double(image.width) * image.height));
    return mean;
}

bool same_mapping(const Texture& a, const Texture& b) {
    return a.texcoord_set == b.texcoord_set && a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v &&
           a.uv_from_texcoord == b.uv_from_texcoord;
}

}  // namespace

bool SpecularGlossiness::read(const tinygltf::Material& from, const std::string& user, Material& material) {
    const GltfProperties given(from.extensions, kSpecularGlossiness);
    if (!given.present()) return false;
    ++count_;
    const auto fraction = [](double value) { return float(std::clamp(value, 0.0, 1.0)); };
    Factors factors;
    for (int k = 0; k < 4; ++k) factors.diffuse[k] = fraction(given.number("diffuseFactor", k, 1.0));
    for (int k = 0; k < 3; ++k) factors.specular[k] = fraction(given.number("specularFactor", k, 1.0));
    factors.glossiness = fraction(given.number("glossinessFactor", 1.0));

    const MetalRough uniform = convert(glm::vec3(factors.diffuse), factors.specular);
    material.base_color = glm::vec4(uniform.base_color, factors.diffuse.a);
    material.metallic = uniform.metallic;
    material.roughness = 1.0f - factors.glossiness;

    const tinygltf::TextureInfo diffuse = given.texture("diffuseTexture");
    const tinygltf::TextureInfo gloss = given.texture("specularGlossinessTexture");
    const Texture diffuse_texture = textures_.reference(diffuse, "diffuse");
    const Texture gloss_texture = textures_.reference(gloss, "specular-glossiness");
    Images images{textures_.image_of(diffuse.index), textures_.image_of(gloss.index), false};
    const auto usable = [&](int image, const tinygltf::TextureInfo& info, const Texture& texture) {
        if (info.index < 0 || texture.texcoord_set < 0 || image == GltfTextures::kBasis) return false;
        return textures_.images().decoded(image, user) != nullptr;
    };
    if (!usable(images.diffuse, diffuse, diffuse_texture)) images.diffuse = -1;
    if (!usable(images.specular_glossiness, gloss, gloss_texture)) images.specular_glossiness = -1;
    if (images.diffuse < 0 && images.specular_glossiness < 0) return true;
    if (images.specular_glossiness < 0 && brightness(factors.specular) < kDielectric) {
        // No metal at all: the diffuse colour is the base colour, but for a factor.
        material.base_color_texture = textures_.texture(diffuse, "diffuse");
        return true;
    }
    if (images.diffuse >= 0 && images.specular_glossiness >= 0 && !same_mapping(diffuse_texture, gloss_texture)) {
        images.mean = true;
        warnings_.add(
            fmt::format("{}: specular-glossiness texture lies elsewhere than the diffuse one, its mean is used", user));
    }
    if (!images.mean && !fit_together(images, user)) {
        images.mean = true;
        warnings_.add(fmt::format(
            "{}: diffuse and specular-glossiness texture together make more than 2^28 pixels, the mean of the second "
            "is used",
            user));
    }
    Texture both = images.diffuse >= 0 ? diffuse_texture : gloss_texture;
    const auto [base_color, metallic_roughness] = converted(images, factors, user);
    material.base_color = glm::vec4(1.0f, 1.0f, 1.0f, factors.diffuse.a);
    material.metallic = material.roughness = 1.0f;
    both.image = base_color;
    material.base_color_texture = both;
    both.image = metallic_roughness;
    material.metallic_roughness_texture = both;
    return true;
}

bool SpecularGlossiness::fit_together(const Images& images, const std::string& user) {
    if (images.diffuse < 0 || images.specular_glossiness < 0) return true;
    const Image& a = *textures_.images().decoded(images.diffuse, user);
    const Image& b = *textures_.images().decoded(images.specular_glossiness, user);
    return std::int64_t(std::max(a.width, b.width)) * std::max(a.height, b.height) <= kMaxPixels;
}

std::pair<int, int> SpecularGlossiness::converted(const Images& images, const Factors& factors,
                                                  const std::string& user) {
    const Key key{images.diffuse,     images.mean ? -2 - images.specular_glossiness : images.specular_glossiness,
                  factors.diffuse.r,  factors.diffuse.g,
                  factors.diffuse.b,  factors.specular.r,
                  factors.specular.g, factors.specular.b,
                  factors.glossiness};
    if (const auto known = known_.find(key); known != known_.end()) return known->second;
    Image white(1, 1, 4);
    white.pixels = {1.0f, 1.0f, 1.0f, 1.0f};
    const Image* const diffuse = images.diffuse < 0 ? &white : textures_.images().decoded(images.diffuse, user);
    const Image* gloss =
        images.specular_glossiness < 0 ? &white : textures_.images().decoded(images.specular_glossiness, user);
    Image mean;
    if (images.mean) {
        mean = mean_texel(*gloss);
        gloss = &mean;
    }
    const int width = std::max(diffuse->width, gloss->width), height = std::max(diffuse->height, gloss->height);
    Image base_color(width, height, 4), metallic_roughness(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const glm::vec4 d = linear_texel(*diffuse, x, y, width, height);
            const glm::vec4 s = linear_texel(*gloss, x, y, width, height);
            const MetalRough texel =
                convert(glm::vec3(d) * glm::vec3(factors.diffuse), glm::vec3(s) * factors.specular);
            float* const base = base_color.at(x, y);
            for (int k = 0; k < 3; ++k) base[k] = srgb_from_linear(texel.base_color[k]);
            base[3] = d.a;
            float* const rough = metallic_roughness.at(x, y);
            rough[1] = 1.0f - factors.glossiness * s.a;
            rough[2] = texel.metallic;
        }
    }
    const int base = textures_.images().add(std::move(base_color), user + " base colour");
    const int rough = textures_.images().add(std::move(metallic_roughness), user + " metallic-roughness");
    return known_[key] = {base, rough};
}

void SpecularGlossiness::warn_about_conversions() {
    if (count_ > 0)
        warnings_.add(fmt::format("{}: {} material{} of specular-glossiness, converted to metallic-roughness",
                                  gltf_.path.filename().string(), count_, count_ == 1 ? "" : "s"));
}

}  // namespace pellucid
