#pragma once

#include <pellucid/api.h>
#include <pellucid/image.h>
#include <pellucid/volume.h>

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// How a texture coordinate outside 0..1 is brought back inside.
enum class Wrap : std::uint32_t { kRepeat, kMirror, kClamp };

/// A reference from a material to one of Scene::images.
struct Texture {
    int image = -1;        ///< index into Scene::images, -1 for none
    int texcoord_set = 0;  ///< 0 or 1: which of Mesh::texcoords
    Wrap wrap_u = Wrap::kRepeat;
    Wrap wrap_v = Wrap::kRepeat;
    bool nearest = false;              ///< true: no interpolation between texels
    glm::mat3 uv_from_texcoord{1.0f};  ///< KHR_texture_transform; applied to (u, v, 1)
};

/// What extensions of glTF add to an opaque surface, outermost first: a clear coat, the fibres of cloth, and what the
/// boundary below them reflects. KHR_materials_clearcoat, _sheen, _specular, _iridescence and _anisotropy.
struct Finish {
    float clearcoat = 0.0f;               ///< 0..1; share of the surface that has the coat, of index 1.5
    Texture clearcoat_texture;            ///< red multiplies clearcoat (linear)
    float clearcoat_roughness = 0.0f;     ///< perceptual, 0..1
    Texture clearcoat_roughness_texture;  ///< green multiplies clearcoat_roughness (linear)
    Texture clearcoat_normal_texture;     ///< as Material::normal_texture, which does not tilt the coat
    float clearcoat_normal_scale = 1.0f;

    glm::vec3 sheen_color{0.0f};      ///< linear RGB, 0..1
    Texture sheen_color_texture;      ///< multiplies sheen_color; its image is sRGB-encoded
    float sheen_roughness = 0.0f;     ///< perceptual, 0..1
    Texture sheen_roughness_texture;  ///< alpha multiplies sheen_roughness

    float specular = 1.0f;           ///< 0..1; strength of what a dielectric reflects
    Texture specular_texture;        ///< alpha multiplies specular
    glm::vec3 specular_color{1.0f};  ///< linear RGB, >= 0; multiplies what it reflects head-on, which stays below 1
    Texture specular_color_texture;  ///< multiplies specular_color; its image is sRGB-encoded

    float iridescence = 0.0f;         ///< 0..1; share of the surface under a thin film
    Texture iridescence_texture;      ///< red multiplies iridescence (linear)
    float film_ior = 1.3f;            ///< >= 1
    float film_thinnest_nm = 100.0f;  ///< >= 0; where the texture is 0
    float film_thickest_nm = 400.0f;  ///< >= 0; where it is 1, or there is none
    Texture film_thickness_texture;   ///< green, linear

    float anisotropy = 0.0f;           ///< 0..1; the GGX lobe is wider along the direction of anisotropy
    float anisotropy_rotation = 0.0f;  ///< radians, counter-clockwise from the tangent
    Texture anisotropy_texture;        ///< red, green: direction from -1..1; blue multiplies anisotropy (linear)

    bool coated() const { return clearcoat > 0.0f; }
    bool has_sheen() const { return sheen_color != glm::vec3(0.0f); }
    /// The surface is as if there were no extension.
    bool plain() const {
        return !coated() && !has_sheen() && specular == 1.0f && specular_texture.image < 0 &&
               specular_color == glm::vec3(1.0f) && specular_color_texture.image < 0 && iridescence == 0.0f &&
               anisotropy == 0.0f;
    }
};

/// glTF metallic-roughness material with extensions.
struct Material {
    std::string name;

    glm::vec4 base_color{1.0f};          ///< linear RGB 0..1, alpha 0..1; tints what is transmitted
    Texture base_color_texture;          ///< multiplies base_color; its image is sRGB-encoded
    float metallic = 0.0f;               ///< 0..1
    float roughness = 0.0f;              ///< perceptual, 0..1; the square root of the width of the GGX lobe
    Texture metallic_roughness_texture;  ///< green multiplies roughness, blue metallic (linear)
    glm::vec3 emission{0.0f};            ///< linear radiance, emissive strength included
    Texture emission_texture;            ///< multiplies emission; its image is sRGB-encoded
    float alpha_cutoff = 0.0f;           ///< fragments with less alpha are left out; 0 keeps all
    /// Of thin-walled glass and opaque surfaces: they cover only the share `alpha` of what lies behind. Opaque ones do so
    /// ray by ray, at random, so that the mean over samples is right.
    bool alpha_is_coverage = false;
    bool unlit = false;        ///< shows base_color itself
    bool double_sided = true;  ///< opaque surfaces that are not are seen from the front only; glTF says which

    float transmission = 0.0f;          ///< 0..1; share of the light that enters instead of scattering at the surface
    Texture transmission_texture;       ///< red channel multiplies transmission (linear)
    float ior = 1.5f;                   ///< index of refraction at the Fraunhofer d line, >= 1
    float dispersion = 0.0f;            ///< KHR_materials_dispersion: 20 / Abbe number; 0 for none
    float thickness = 0.0f;             ///< KHR_materials_volume thicknessFactor; 0: thin-walled, does not bend light
    glm::vec3 attenuation_color{1.0f};  ///< 0..1, what is left of white light after attenuation_distance
    float attenuation_distance = std::numeric_limits<float>::infinity();  ///< metres, > 0

    /// KHR_materials_diffuse_transmission: share of the diffusely scattered light that leaves on the other side, 0..1.
    /// Through a solid it is weakened by sigma_a() along the way that light from a Light takes in it.
    float diffuse_transmission = 0.0f;
    glm::vec3 diffuse_transmission_color{1.0f};  ///< linear RGB, 0..1; tints that light

    Texture
        normal_texture;  ///< red, green, blue 0..1: direction from -1..1 in the frame of Mesh::tangents; 128/255 is 0
    float normal_scale = 1.0f;  ///< of the direction's first two components
    /// Red: share of the environment's light that reaches the surface. Frames that follow what hides it, and path tracing,
    /// leave it out.
    Texture occlusion_texture;
    float occlusion_strength = 1.0f;  ///< 0..1; 0: the texture has no effect
    Finish finish;                    ///< of opaque surfaces

    bool transmissive() const { return transmission > 0.0f; }
    /// An opaque surface that lets light of lights through, scattered.
    bool translucent() const { return diffuse_transmission > 0.0f && !transmissive() && !unlit && metallic < 1.0f; }
    /// Opaque, and not there for rays that come from behind. Light goes through solids that are translucent.
    bool single_sided() const { return !double_sided && !transmissive() && !translucent(); }
    /// Opaque, and there for some rays only.
    bool has_holes() const { return alpha_cutoff > 0.0f || (alpha_is_coverage && !transmissive()); }
    /// What is seen of it depends on the directions of its texture coordinates.
    bool uses_tangents() const {
        return normal_texture.image >= 0 || finish.anisotropy > 0.0f ||
               (finish.coated() && finish.clearcoat_normal_texture.image >= 0);
    }
    /// Bounds a solid of glass, as opposed to an opaque or a thin-walled surface.
    bool refractive() const { return transmissive() && thickness > 0.0f; }
    /// Absorption (translucent: extinction) coefficient per metre, `-ln(attenuation_color) / attenuation_distance`.
    PELLUCID_API glm::vec3 sigma_a() const;
};

/// An indexed triangle mesh in its own coordinate frame.
struct Mesh {
    std::string name;
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;       ///< unit, one per position
    std::vector<glm::vec2> texcoords[2];  ///< empty, or one per position; v runs downwards (glTF)
    std::vector<glm::vec4> colors;        ///< empty, or one linear RGBA per position
    /// Empty, or one per position: unit, the direction in which u of the texture coordinates grows; w, 1 or -1, times
    /// normal x tangent is the direction of -v. A zero vector, or none: the triangle's own texture coordinates say it.
    std::vector<glm::vec4> tangents;
    std::vector<glm::uvec3> triangles;  ///< counter-clockwise seen from outside
};

/// New vertices of one mesh of a scene.
struct MovedMesh {
    int mesh = 0;                          ///< Scene::meshes
    std::span<const glm::vec3> positions;  ///< in the mesh's own frame, as many as it has
    std::span<const glm::vec3> normals;    ///< alike
};

/// One placement of a mesh.
struct Object {
    std::string name;
    int mesh = 0;
    int material = 0;
    glm::mat4 world_from_object{1.0f};  ///< affine, invertible; may mirror
    /// Refracting objects of one number >= 0 bound one solid together, each with surface properties of its own; they have
    /// one transform, and all solids of one of their meshes are of the same meshes. -1: a solid of its own. The medium
    /// of a solid is that of most of its surface.
    int body = -1;
    /// Where solids overlap, the one of the highest priority displaces the others (nested dielectrics: Schmidt & Budge
    /// 2002). Of equal ones the solid of less volume does, then the later object.
    int priority = 0;
};

/// A camera: right-handed, looking along its own -Z with +Y up.
struct Camera {
    std::string name;
    glm::mat4 world_from_view{1.0f};  ///< rigid
    float vertical_fov = 0.5235988f;  ///< radians, 0 < fov < pi (30 degrees)
    float near_plane = 0.0f;          ///< metres, > 0; 0: chosen from the scene
    float far_plane = 0.0f;           ///< metres, > near_plane; 0: chosen from the scene
    bool orthographic = false;
    float vertical_extent = 0.0f;  ///< orthographic: height of the view volume in metres
};

/// A light of KHR_lights_punctual, with a size. Point and spot lights are spheres, directional lights are discs in the
/// sky; a size of 0 makes them points.
struct Light {
    enum class Kind : std::uint32_t { kDirectional, kPoint, kSpot };

    std::string name;
    Kind kind = Kind::kPoint;
    glm::vec3 intensity{1.0f};               ///< linear RGB; point and spot W/sr, directional W/m2
    glm::vec3 position{0.0f};                ///< world, m; point and spot
    glm::vec3 direction{0.0f, 0.0f, -1.0f};  ///< unit, world: the way the light goes; directional and spot
    float range = std::numeric_limits<float>::infinity();  ///< m; point and spot end here
    float inner_cone_angle = 0.0f;                         ///< radians from the axis; spot: full light up to here
    float outer_cone_angle = 0.7853982f;                   ///< radians, > inner_cone_angle: none beyond
    float radius = 0.0f;                                   ///< m, >= 0; of the sphere of point and spot lights
    /// Radians, 0..pi without pi, of directional lights. The default is the sun's, 0.53 degrees.
    float angular_diameter = 0.00925025f;
};

/// One placement of a volume.
struct VolumeObject {
    std::string name;
    int volume = 0;
    /// Moves, turns, mirrors and scales alike in all directions. A scale is one of all lengths: what a ray loses, scatters
    /// and picks up on its way through stays what it is.
    glm::mat4 world_from_volume{1.0f};
    /// Refracting objects that it was made from: where volumes are drawn, it stands for them. Their surfaces say where
    /// rays enter it (parameter `proxy` of ihrke-2007), sharper than its voxels can.
    std::vector<int> objects;
};

/// Nodes, animations, skins and morph targets of a file, as load_scene() read them. See pellucid/animation.h.
struct Rig;

/// A checked scene: every index is in range, every number finite, every normal of unit length.
struct Scene {
    std::string source;  ///< what load_scene was given
    /// World position, m, of the origin of the frame in which all transforms, cameras and lights of the scene are
    /// given. Not 0 where a file's content lies more than 8 radii from the file's own origin: 32-bit numbers are too
    /// coarse there. Subtract it, in double precision, from a position of the file's world to get one of the scene.
    /// "World" in the descriptions of scenes, renderer and tracers means this frame.
    glm::dvec3 origin{0.0};
    std::vector<Image> images;
    std::vector<std::string> image_names;  ///< one per image, for messages
    std::vector<Material> materials;
    std::vector<Mesh> meshes;
    std::vector<Object> objects;
    std::vector<std::shared_ptr<const Volume>> volumes;  ///< copies of the scene share them; none is null
    std::vector<VolumeObject> volume_objects;            ///< where boxes overlap, the smaller one counts
    std::vector<Camera> cameras;
    std::vector<Light> lights;
    std::shared_ptr<const Rig> rig;     ///< what pose_at() poses; copies share it; null where nothing is animated
    std::vector<std::string> warnings;  ///< one line each; what was approximated, repaired or left out
    PELLUCID_API std::uint64_t triangle_count() const;  ///< over all objects; instances count each time
};

/// Sphere around a set of objects, in the scene's frame, and their axis-aligned box about the same centre.
struct Bounds {
    glm::vec3 center{0.0f};
    float radius = 0.0f;
    glm::vec3 half_size{0.0f};  ///< half the sides of the box, m
};
/// Bounds of all objects and volumes: centre of the box, radius to the farthest vertex or corner of a volume's box.
PELLUCID_API Bounds scene_bounds(const Scene& scene);

/// What makes a solid wax, jade or skin.
struct Translucency {
    glm::vec3 color{1.0f};  ///< 0..1, what is left of white light after `distance`
    float distance = 1.0f;  ///< m, > 0
};
/// Makes every material of the scene translucent: opaque and no metal, half of what it scatters on either side. Its
/// base colour, roughness and textures stay. Throws Error for values out of range.
PELLUCID_API void make_translucent(Scene& scene, const Translucency& translucency);

/// A crease angle that each shell of a mesh gets by itself. Where some of its edges are sharp, others bend gently and
/// hardly any lie between, the sharp ones stay sharp: a cube is a cube, a cylinder has rims. Otherwise it is smooth.
inline constexpr float kCreasesByShell = std::numeric_limits<float>::infinity();

/// How files without materials of their own become glass, how meshes are repaired, and what animated files show.
struct LoadOptions {
    std::optional<float> ior;                    ///< >= 1; overrides every refractive material
    std::optional<glm::vec3> attenuation_color;  ///< 0..1; likewise
    std::optional<float> attenuation_distance;   ///< metres, > 0; likewise
    std::optional<Translucency> translucent;     ///< see make_translucent()
    /// Made normals are shared across edges bent less than this (radians, 0..pi), or kCreasesByShell. That is 0 for
    /// .stl files, which store one normal per facet, unless remake_normals is set.
    float crease_angle = kCreasesByShell;
    /// Replace normals that a mesh file brings along by made ones.
    bool remake_normals = false;
    /// Closed glTF meshes of transmissive materials are solid glass, whether a material has a volume or not.
    bool solid = false;
    /// Name, or else number from 0, of the animation whose pose is loaded. None, and no time either: the file's own
    /// node transforms and weights.
    std::optional<std::string> animation;
    std::optional<double> time_s;  ///< >= 0, default 0; of the animation, or without one of the file's first
    /// Object::priority of all objects of that name; it must be there. What glTF nodes say in extras.pellucid.priority
    /// holds for others.
    struct Priority {
        std::string object;
        int priority = 0;
    };
    std::vector<Priority> priorities;
    /// A scene file may name files outside its own folder. Otherwise an image there is left out with a warning, and a
    /// buffer, a volume or a material library there is an error. Links and ".." are resolved first.
    bool allow_outside = false;
    /// Of OpenVDB files; empty: grids have the names of fields. See load_volume().
    std::vector<GridMapping> grids;
};

/// Loads a scene.
///
/// `source` is a file (`.gltf`, `.glb`, `.obj`, `.ply`, `.stl`, `.off`, `.3ds`, `.vdb`), a procedural
/// shape `shape:NAME[,PARAMETER=VALUE...]` (see shape_infos()) or volume `volume:NAME[,...]` (volume_infos()). glTF
/// brings its own materials; of every other kind of mesh the whole file is glass. Skins and morph targets of glTF are applied, at rest or as
/// LoadOptions::animation says; meshes with a skin get vertices in the world's frame and objects at the identity.
/// Throws Error in one line if the file is missing, malformed, empty, or requires a glTF extension
/// that is not supported. What could be repaired or was left out is in Scene::warnings.
PELLUCID_API Scene load_scene(const std::string& source, const LoadOptions& options = {});

/// Names that `shape:` accepts, with a line about each and its parameters.
struct ShapeParameter {
    std::string_view name;
    double default_value;
    double minimum;
    double maximum;
    std::string_view doc;
};
struct ShapeInfo {
    std::string_view name;
    std::string_view doc;
    std::vector<ShapeParameter> parameters;
};
PELLUCID_API const std::vector<ShapeInfo>& shape_infos();
/// The same of `volume:`.
PELLUCID_API const std::vector<ShapeInfo>& volume_infos();

/// Camera on a sphere around `bounds`, looking at its centre.
/// azimuth_deg 0 looks along -Z from +Z, growing towards +X; elevation_deg -90..90;
/// distance in bounding-sphere radii, > 1.
PELLUCID_API Camera orbit_camera(const Bounds& bounds, float azimuth_deg, float elevation_deg, float distance,
                                 float vertical_fov);

/// Distance, in radii, at which a sphere fills `share` of the image height (0 < share < 1).
PELLUCID_API float framing_distance(float vertical_fov, float share);

/// The default camera: azimuth 0, elevation 15 degrees, `bounds` filling 70% of the picture's height,
/// or of its width where that is less.
PELLUCID_API Camera framing_camera(const Bounds& bounds, std::uint32_t width, std::uint32_t height, float vertical_fov);

}  // namespace pellucid
