#pragma once

// Textured properties of a material at a point of a triangle. Reads textures exactly as the renderer
// does: bilinear or nearest on the finest level, decoded before it is interpolated.

#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <cstdint>

namespace pellucid::reference {

/// What the vertices of a mesh carry for its material, interpolated.
struct SurfaceAttributes {
    glm::vec2 texcoords[2] = {glm::vec2(0.0f), glm::vec2(0.0f)};  ///< 0 where the mesh has none
    glm::vec4 color{1.0f};                                        ///< linear RGBA; white where the mesh has none
};

/// At `position = (1 - u - v) p0 + u p1 + v p2` of triangle `triangle` of the mesh.
SurfaceAttributes interpolate_attributes(const Mesh& mesh, std::uint32_t triangle, glm::vec2 uv);

/// How the colours of an image are stored.
enum class Encoding { kLinear, kSrgb };

/// RGBA of a texture, 0..1, alpha always linear; white where `texture` is none.
glm::vec4 sample_texture(const Scene& scene, const Texture& texture, Encoding encoding,
                         const SurfaceAttributes& attributes);

/// Base colour with texture and vertex colour, kept to 0..1: no surface scatters more than it gets.
glm::vec4 base_color(const Scene& scene, const Material& material, const SurfaceAttributes& attributes);

/// Emitted radiance with its texture.
glm::vec3 emission(const Scene& scene, const Material& material, const SurfaceAttributes& attributes);

/// Transmission with its texture, 0..1.
float transmission(const Scene& scene, const Material& material, const SurfaceAttributes& attributes);

struct MetallicRoughness {
    float metallic, roughness;  ///< 0..1
};
/// Both with their texture.
MetallicRoughness metallic_roughness(const Scene& scene, const Material& material, const SurfaceAttributes& attributes);

/// What a finish is at a point, with its textures; all 0..1 unless said otherwise.
struct FinishTexels {
    double clearcoat, clearcoat_roughness;
    glm::dvec3 sheen_color;
    double sheen_roughness;
    double specular;
    glm::dvec3 specular_color;  ///< >= 0
    double iridescence, film_thickness_nm;
    double anisotropy;
    glm::dvec2 anisotropy_direction;  ///< unit, in the frame of tangents
};
FinishTexels finish_texels(const Scene& scene, const Finish& finish, const SurfaceAttributes& attributes);

}  // namespace pellucid::reference
