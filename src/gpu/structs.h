// Structs that C++ and GLSL share. Laid out so that std430 and C++ agree without padding: every
// vec4 and mat4 starts at a multiple of 16 bytes and every struct is a multiple of 16 bytes long.
#ifndef PELLUCID_GPU_STRUCTS_H
#define PELLUCID_GPU_STRUCTS_H

#ifdef __cplusplus
#include <cstdint>
#include "core/math.h"
namespace pellucid::gpu {
// NOLINTBEGIN(readability-identifier-naming): GLSL's names
using vec4 = glm::vec4;
using mat4 = glm::mat4;
using uint = std::uint32_t;
// NOLINTEND(readability-identifier-naming)
#endif

#define PELLUCID_NO_TEXTURE 0xffffffffu
#define PELLUCID_NO_TRIANGLE 0xffffffffu
#define PELLUCID_NO_FINISH 0xffffffffu
#define PELLUCID_BACK_FACE 0x80000000u  // top bit of a layer record's triangle word
#define PELLUCID_EMPTY_DEPTH 1e30       // metres; farther than anything
#define PELLUCID_MATERIAL_UNLIT 1u
#define PELLUCID_MATERIAL_COVERAGE 2u      // alpha is coverage
#define PELLUCID_MATERIAL_SINGLE_SIDED 4u
// Parts of a picture's light: 1 + their number in kLightParts (pellucid/reference.h).
#define PELLUCID_ALL_LIGHT 0u
#define PELLUCID_EMITTED 1u
#define PELLUCID_DIRECT 2u
#define PELLUCID_CAUSTIC 3u
#define PELLUCID_INDIRECT 4u
#define PELLUCID_TEXTURE_NEAREST 1u
#define PELLUCID_TEXTURE_SRGB 2u
#define PELLUCID_TEXTURE_SECOND_SET 4u

// The environment's pyramid (environment_pyramid.glsl) and its filtered levels (filter_levels.glsl), texels.
#define PELLUCID_PYRAMID_SIZE 512
#define PELLUCID_PYRAMID_LEVELS 8
#define PELLUCID_FILTER_SIZE 256
#define PELLUCID_FILTER_LEVELS 8
#define PELLUCID_FILTER_WIDTH 608     // of all levels side by side
#define PELLUCID_FACET_TABLE_SIZE 32  // side of the table of what facets reflect

struct FrameConstants {
    mat4 view_from_world;
    mat4 world_from_view;
    mat4 clip_from_view;
    // View-plane position of pixel coordinate (i, j) of the whole picture, centres at +0.5: (x + i * z, y - j * w),
    // at depth 1 for a perspective camera, in metres for an orthographic one.
    vec4 film;
    float near_plane;
    float far_plane;
    float glass_near;  // depth range that refracting objects span, metres
    float glass_far;
    float depth_scale;  // power of two that brings depths below 1, so that scaling is exact
    uint orthographic;
    uint width;  // of the tile that is drawn, pixels
    uint height;
    uint object_count;
    uint environment_kind;
    uint sample_index;  // of the picture, 0 on
    uint first_x;  // of the tile in the picture, pixels
    uint first_y;
    float environment_cosine;  // of its rotation about +Y
    float environment_sine;
    float environment_intensity;
    uint light_part;  // PELLUCID_ALL_LIGHT, or the part of the picture that is drawn alone (light_parts.glsl)
    uint occlusion;   // 1: occlusion textures weaken the environment's light; 0: rays find what hides it
    uint unused_1;
    uint unused_2;
    vec4 environment_uniform;
    vec4 irradiance[9];  // spherical harmonics, see irradiance_coefficients()
};

struct ObjectRecord {
    mat4 world_from_object;
    mat4 world_from_object_normal;  // inverse transpose
    uint material;
    uint first_triangle;  // of this object among all objects' triangles
    uint first_corner;    // of its mesh in GpuScene::indices
    uint mirrored;        // 1: the transform turns the winding around
};

struct MaterialRecord {
    vec4 base_color;
    vec4 emission;  // rgb, radiance
    vec4 sigma_a;   // rgb, 1/m; a: Material::thickness, of the mesh's own frame
    float ior;
    float transmission;
    float alpha_cutoff;
    uint flags;
    uint base_color_texture;
    uint emission_texture;
    uint transmission_texture;
    uint metallic_roughness_texture;
    float metallic;
    float roughness;  // perceptual
    float dispersion;
    uint translucent;  // 1: diffuse_transmission is not 0
    vec4 diffuse_transmission;  // rgb, colour times factor; base_color is without that factor's share
    uint normal_texture;
    float normal_scale;
    uint occlusion_texture;
    float occlusion_strength;
    uint finish;  // FinishRecord, or PELLUCID_NO_FINISH
    uint unused_0;
    uint unused_1;
    uint unused_2;
};

// pellucid::Finish.
struct FinishRecord {
    vec4 sheen;     // rgb, colour; a: roughness
    vec4 specular;  // rgb, colour; a: strength
    float clearcoat;
    float clearcoat_roughness;
    float clearcoat_normal_scale;
    float iridescence;
    float film_ior;
    float film_thinnest_nm;
    float film_thickest_nm;
    float anisotropy;
    float anisotropy_cosine;  // of its rotation
    float anisotropy_sine;
    uint clearcoat_texture;
    uint clearcoat_roughness_texture;
    uint clearcoat_normal_texture;
    uint sheen_color_texture;
    uint sheen_roughness_texture;
    uint specular_texture;
    uint specular_color_texture;
    uint iridescence_texture;
    uint film_thickness_texture;
    uint anisotropy_texture;
};

// Part of a texture page, and how to sample it.
struct TextureRecord {
    vec4 uv_row0;  // u = dot(row0.xyz, (texcoord, 1))
    vec4 uv_row1;
    uint page;
    uint x;  // of the top left texel on the page
    uint y;
    uint width;
    uint height;
    uint wrap_u;  // pellucid::Wrap
    uint wrap_v;
    uint flags;
};

#ifdef __cplusplus
static_assert(sizeof(FrameConstants) == 3 * 64 + 16 + 5 * 16 + 16 + 9 * 16);
static_assert(sizeof(ObjectRecord) == 144);
static_assert(sizeof(MaterialRecord) == 144);
static_assert(sizeof(FinishRecord) == 112);
static_assert(sizeof(TextureRecord) == 64);
}  // namespace pellucid::gpu
#endif

#endif
