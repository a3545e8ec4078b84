#include "scene/mesh_files/mtl_images.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pellucid {
namespace {

/// The nearest texel of `image` for texel (x, y) of an image of another size.
const float* texel(const Image& image, const Image& of, int x, int y) {
    return image.at(int(std::int64_t(x) * image.width / of.width), int(std::int64_t(y) * image.height / of.height));
}

Image larger_of(const Image& a, const Image& b, int channels) {
    return Image(std::max(a.width, b.width), std::max(a.height, b.height), channels);
}

/// Normal maps are blue; files of heights are grey, whatever their number of channels.
bool is_grey(const Image& image) {
    if (image.channels < 3) return true;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const float* const p = image.at(x, y);
            // Compressed grey is off by a few of 255 steps.
            if (std::max(std::abs(p[0] - p[1]), std::abs(p[1] - p[2])) > 0.04f) return false;
        }
    }
    return true;
}

void store_normal(float* to, const glm::vec3& direction) {
    const glm::vec3 normal = glm::normalize(direction) * 0.5f + 0.5f;
    for (int k = 0; k < 3; ++k) to[k] = normal[k];
}

}  // namespace

Image with_alpha(const Image& color, const Image& alpha) {
    Image result = larger_of(color, alpha, 4);
    for (int y = 0; y < result.height; ++y) {
        for (int x = 0; x < result.width; ++x) {
            float* const out = result.at(x, y);
            for (int k = 0; k < 3; ++k)
                out[k] = color.channels == 0 ? 1.0f : texel(color, result, x, y)[color.channels < 3 ? 0 : k];
            const float* const a = texel(alpha, result, x, y);
            const bool own = alpha.channels == 2 || alpha.channels == 4;
            out[3] = own ? a[alpha.channels - 1] : alpha.channels < 3 ? a[0] : (a[0] + a[1] + a[2]) / 3.0f;
        }
    }
    return result;
}

Image roughness_and_metal(const Image& roughness, const Image& metal) {
    Image result = larger_of(roughness, metal, 3);
    for (int y = 0; y < result.height; ++y) {
        for (int x = 0; x < result.width; ++x) {
            float* const out = result.at(x, y);
            out[0] = 1.0f;
            out[1] = roughness.channels == 0 ? 1.0f : texel(roughness, result, x, y)[0];
            out[2] = metal.channels == 0 ? 1.0f : texel(metal, result, x, y)[0];
        }
    }
    return result;
}

Image normals_from_bump(const Image& bump, float scale, bool clamped) {
    Image result(bump.width, bump.height, 3);
    const bool heights = is_grey(bump);
    const auto height = [&](int x, int y) {
        const int w = bump.width, h = bump.height;
        return *(clamped ? bump.at(std::clamp(x, 0, w - 1), std::clamp(y, 0, h - 1))
                         : bump.at((x + w) % w, (y + h) % h));
    };
    for (int y = 0; y < result.height; ++y) {
        for (int x = 0; x < result.width; ++x) {
            if (heights) {
                const float along_u = 0.5f * (height(x + 1, y) - height(x - 1, y));
                const float along_rows = 0.5f * (height(x, y + 1) - height(x, y - 1));
                store_normal(result.at(x, y), {-scale * along_u, scale * along_rows, 1.0f});
            } else {
                const float* const p = bump.at(x, y);
                const glm::vec3 normal = glm::vec3(p[0], p[1], p[2]) * 2.0f - 1.0f;
                store_normal(result.at(x, y), {scale * normal.x, scale * normal.y, std::max(normal.z, 1e-3f)});
            }
        }
    }
    return result;
}

}  // namespace pellucid
