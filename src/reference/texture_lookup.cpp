#include "reference/texture_lookup.h"

#include "core/math.h"

#include <algorithm>
#include <cmath>

namespace pellucid::reference {
namespace {

/// `x` in 0..1; what is no number is 0.
float to_unit_range(float x) { return x > 0.0f ? std::min(x, 1.0f) : 0.0f; }

/// IEC 61966-2-1.
float linear_from_srgb(float x) { return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f); }

int wrap_texel(int i, int size, Wrap wrap) {
    if (wrap == Wrap::kClamp) return std::clamp(i, 0, size - 1);
    const int period = wrap == Wrap::kMirror ? 2 * size : size;
    const int j = ((i % period) + period) % period;
    return j < size ? j : 2 * size - 1 - j;
}

/// Brings a coordinate near 0..1 without a change to what is seen: far repetitions would lose their
/// texels to rounding. Two periods hold a mirrored texture whole.
float near_origin(float x, Wrap wrap) {
    if (wrap == Wrap::kClamp) return std::clamp(x, -1.0f, 2.0f);
    return x - 2.0f * std::floor(0.5f * x);
}

/// RGBA as stored; one or two channels are grey, or grey and alpha.
glm::vec4 stored_texel(const Image& image, int x, int y) {
    const float* p = image.at(x, y);
    switch (image.channels) {
        case 1:
            return {p[0], p[0], p[0], 1.0f};
        case 2:
            return {p[0], p[0], p[0], p[1]};
        case 3:
            return {p[0], p[1], p[2], 1.0f};
        default:
            return {p[0], p[1], p[2], p[3]};
    }
}

glm::vec4 texel(const Image& image, const Texture& texture, Encoding encoding, int x, int y) {
    glm::vec4 value =
        stored_texel(image, wrap_texel(x, image.width, texture.wrap_u), wrap_texel(y, image.height, texture.wrap_v));
    for (int c = 0; c < 4; ++c) {
        value[c] = to_unit_range(value[c]);
        if (c < 3 && encoding == Encoding::kSrgb) value[c] = linear_from_srgb(value[c]);
    }
    return value;
}

template <class Vector>
Vector interpolate(const std::vector<Vector>& values, glm::uvec3 t, glm::vec2 uv) {
    return (1.0f - uv.x - uv.y) * values[t.x] + uv.x * values[t.y] + uv.y * values[t.z];
}

}  // namespace

SurfaceAttributes interpolate_attributes(const Mesh& mesh, std::uint32_t triangle, glm::vec2 uv) {
    SurfaceAttributes attributes;
    const glm::uvec3 t = mesh.triangles[triangle];
    for (int set = 0; set < 2; ++set) {
        if (!mesh.texcoords[set].empty()) attributes.texcoords[set] = interpolate(mesh.texcoords[set], t, uv);
    }
    if (!mesh.colors.empty()) attributes.color = interpolate(mesh.colors, t, uv);
    return attributes;
}

glm::vec4 sample_texture(const Scene& scene, const Texture& texture, Encoding encoding,
                         const SurfaceAttributes& attributes) {
    if (texture.image < 0) return glm::vec4(1.0f);
    const Image& image = scene.images[std::size_t(texture.image)];
    const glm::vec3 uv = texture.uv_from_texcoord * glm::vec3(attributes.texcoords[texture.texcoord_set], 1.0f);
    glm::vec2 position = glm::vec2(near_origin(uv.x, texture.wrap_u), near_origin(uv.y, texture.wrap_v)) *
                         glm::vec2(image.width, image.height);
    // Coordinates far beyond any texture (a broken file's) end up as no numbers.
    if (!std::isfinite(position.x) || !std::isfinite(position.y)) position = glm::vec2(0.0f);
    if (texture.nearest) {
        const glm::ivec2 i(glm::floor(position));
        return texel(image, texture, encoding, i.x, i.y);
    }
    position -= 0.5f;
    const glm::vec2 low = glm::floor(position), weight = position - low;
    const glm::ivec2 i(low);
    const glm::vec4 upper =
        glm::mix(texel(image, texture, encoding, i.x, i.y), texel(image, texture, encoding, i.x + 1, i.y), weight.x);
    const glm::vec4 lower = glm::mix(texel(image, texture, encoding, i.x, i.y + 1),
                                     texel(image, texture, encoding, i.x + 1, i.y + 1), weight.x);
    return glm::mix(upper, lower, weight.y);
}

glm::vec4 base_color(const Scene& scene, const Material& material, const SurfaceAttributes& attributes) {
    const glm::vec4 product = material.base_color * attributes.color *
                              sample_texture(scene, material.base_color_texture, Encoding::kSrgb, attributes);
    return {to_unit_range(product.r), to_unit_range(product.g), to_unit_range(product.b), to_unit_range(product.a)};
}

glm::vec3 emission(const Scene& scene, const Material& material, const SurfaceAttributes& attributes) {
    if (material.emission == glm::vec3(0.0f)) return material.emission;
    return material.emission * glm::vec3(sample_texture(scene, material.emission_texture, Encoding::kSrgb, attributes));
}

float transmission(const Scene& scene, const Material& material, const SurfaceAttributes& attributes) {
    if (!material.transmissive()) return 0.0f;
    return to_unit_range(material.transmission *
                         sample_texture(scene, material.transmission_texture, Encoding::kLinear, attributes).r);
}

MetallicRoughness metallic_roughness(const Scene& scene, const Material& material,
                                     const SurfaceAttributes& attributes) {
    const glm::vec4 texel = sample_texture(scene, material.metallic_roughness_texture, Encoding::kLinear, attributes);
    return {to_unit_range(material.metallic * texel.b), to_unit_range(material.roughness * texel.g)};
}

FinishTexels finish_texels(const Scene& scene, const Finish& f, const SurfaceAttributes& attributes) {
    const auto linear = [&](const Texture& texture) {
        return glm::dvec4(sample_texture(scene, texture, Encoding::kLinear, attributes));
    };
    const auto color = [&](const Texture& texture) {
        return glm::dvec3(sample_texture(scene, texture, Encoding::kSrgb, attributes));
    };
    FinishTexels texels{};
    texels.clearcoat = double(f.clearcoat) * linear(f.clearcoat_texture).r;
    texels.clearcoat_roughness = double(f.clearcoat_roughness) * linear(f.clearcoat_roughness_texture).g;
    texels.sheen_color = glm::dvec3(f.sheen_color) * color(f.sheen_color_texture);
    texels.sheen_roughness = double(f.sheen_roughness) * linear(f.sheen_roughness_texture).a;
    texels.specular = double(f.specular) * linear(f.specular_texture).a;
    texels.specular_color = glm::dvec3(f.specular_color) * color(f.specular_color_texture);
    texels.iridescence = double(f.iridescence) * linear(f.iridescence_texture).r;
    texels.film_thickness_nm =
        glm::mix(double(f.film_thinnest_nm), double(f.film_thickest_nm), linear(f.film_thickness_texture).g);
    texels.anisotropy = double(f.anisotropy);
    glm::dvec2 direction(1.0, 0.0);
    if (f.anisotropy_texture.image >= 0) {
        const glm::dvec4 texel = linear(f.anisotropy_texture);
        texels.anisotropy *= texel.b;
        direction = glm::dvec2(texel) * 2.0 - 1.0;
        const double length = glm::length(direction);
        direction = length > 0.0 ? direction / length : glm::dvec2(1.0, 0.0);
    }
    const double c = std::cos(double(f.anisotropy_rotation)), s = std::sin(double(f.anisotropy_rotation));
    texels.anisotropy_direction = {c * direction.x - s * direction.y, s * direction.x + c * direction.y};
    return texels;
}

}  // namespace pellucid::reference
