// Extensions of the Khronos registry (github.com/KhronosGroup/glTF, extensions/README.md), and others that real files
// name.
#include <pellucid/gltf_extensions.h>

#include <array>

namespace pellucid {
namespace {

using enum GltfSupport;

/// Ordered by name. docs/gltf.md shows this table; a test compares the two.
constexpr std::array kExtensions = {
    GltfExtension{"ADOBE_materials_clearcoat_specular", kIgnored, "clearcoat of another index"},
    GltfExtension{"ADOBE_materials_clearcoat_tint", kIgnored, "colour of a clearcoat"},
    GltfExtension{"ADOBE_materials_thin_transparency", kIgnored, "use KHR_materials_transmission"},
    GltfExtension{"AGI_articulations", kNoEffect, "the model is drawn at rest"},
    GltfExtension{"AGI_stk_metadata", kNoEffect, "metadata"},
    GltfExtension{"CESIUM_RTC", kNoEffect, "a translation of the whole scene"},
    GltfExtension{"CESIUM_primitive_outline", kIgnored, "outlines of triangles"},
    GltfExtension{"EXT_feature_metadata", kNoEffect, "metadata"},
    GltfExtension{"EXT_instance_features", kNoEffect, "metadata"},
    GltfExtension{"EXT_lights_ies", kIgnored, "light profiles"},
    GltfExtension{"EXT_lights_image_based", kIgnored, "the scene is lit by --environment"},
    GltfExtension{"EXT_mesh_features", kNoEffect, "metadata"},
    GltfExtension{"EXT_mesh_gpu_instancing", kApproximated,
                  "every instance is an object; custom attributes are left out, as are instances of skinned meshes"},
    GltfExtension{"EXT_mesh_manifold", kNoEffect, "meshes are checked for being closed anyway"},
    GltfExtension{"EXT_meshopt_compression", kDrawn, "all modes and filters"},
    GltfExtension{"EXT_structural_metadata", kNoEffect, "metadata"},
    GltfExtension{"EXT_texture_avif", kApproximated, "the texture's other image, else left out with a warning"},
    GltfExtension{"EXT_texture_webp", kDrawn, "textures of WebP images"},
    GltfExtension{"FB_geometry_metadata", kNoEffect, "metadata"},
    GltfExtension{"GODOT_single_root", kNoEffect, "metadata"},
    GltfExtension{"KHR_animation_pointer", kApproximated,
                  "nodes and weights are animated; of materials, lights and cameras the values at rest are drawn"},
    GltfExtension{"KHR_audio_emitter", kNoEffect, "sound"},
    GltfExtension{"KHR_draco_mesh_compression", kDrawn, "triangles with all attributes"},
    GltfExtension{"KHR_gaussian_splatting", kRefused, "splats are no triangles"},
    GltfExtension{"KHR_implicit_shapes", kNoEffect, "shapes of colliders"},
    GltfExtension{"KHR_interactivity", kNoEffect, "the scene is drawn as it starts"},
    GltfExtension{"KHR_lights_punctual", kDrawn, "with --light direct or full, as docs/light.md says"},
    GltfExtension{"KHR_materials_anisotropy", kApproximated,
                  "of opaque materials, as docs/materials.md says; left out of glass"},
    GltfExtension{"KHR_materials_clearcoat", kApproximated,
                  "of opaque materials, as docs/materials.md says; left out of glass"},
    GltfExtension{"KHR_materials_diffuse_transmission", kApproximated,
                  "factors as docs/translucency.md says; textures are left out"},
    GltfExtension{"KHR_materials_dispersion", kDrawn, "colours are refracted apart"},
    GltfExtension{"KHR_materials_emissive_strength", kDrawn, "multiplies the emission"},
    GltfExtension{"KHR_materials_ior", kApproximated, "1 and more; 0, an infinite index, is drawn as 1.5"},
    GltfExtension{"KHR_materials_iridescence", kApproximated,
                  "of opaque materials, as docs/materials.md says; left out of glass"},
    GltfExtension{"KHR_materials_pbrSpecularGlossiness", kApproximated,
                  "converted to metallic-roughness, texel by texel; coloured reflections of dielectrics turn white"},
    GltfExtension{"KHR_materials_sheen", kApproximated,
                  "of opaque materials, as docs/materials.md says; left out of glass"},
    GltfExtension{"KHR_materials_specular", kApproximated,
                  "of opaque materials, as docs/materials.md says; left out of glass"},
    GltfExtension{"KHR_materials_transmission", kDrawn,
                  "thin where there is no volume; --solid makes closed meshes solid"},
    GltfExtension{"KHR_materials_unlit", kDrawn, "shows the base colour"},
    GltfExtension{"KHR_materials_variants", kNoEffect, "the default variant is drawn"},
    GltfExtension{"KHR_materials_volume", kDrawn,
                  "light is followed through the mesh: thickness only says that it is solid"},
    GltfExtension{"KHR_materials_volume_scatter", kIgnored, "drawn as clear glass"},
    GltfExtension{"KHR_mesh_quantization", kDrawn, "attributes of 8 and 16 bits"},
    GltfExtension{"KHR_meshopt_compression", kApproximated, "data of codec version 0; version 1 is refused"},
    GltfExtension{"KHR_node_hoverability", kNoEffect, "interaction"},
    GltfExtension{"KHR_node_selectability", kNoEffect, "interaction"},
    GltfExtension{"KHR_node_visibility", kDrawn, "hidden nodes, and all below them, are left out"},
    GltfExtension{"KHR_physics_rigid_bodies", kNoEffect, "the scene is drawn as it starts"},
    GltfExtension{"KHR_techniques_webgl", kRefused, "shaders in the file"},
    GltfExtension{"KHR_texture_basisu", kApproximated,
                  "the texture's other image, else left out with a warning; of glass it is refused"},
    GltfExtension{"KHR_texture_transform", kDrawn, "offset, rotation, scale and texCoord"},
    GltfExtension{"KHR_xmp", kNoEffect, "metadata"},
    GltfExtension{"KHR_xmp_json_ld", kNoEffect, "metadata"},
    GltfExtension{"MOZ_hubs_components", kNoEffect, "metadata"},
    GltfExtension{"MOZ_lightmap", kIgnored, "light is computed"},
    GltfExtension{"MSFT_lod", kNoEffect, "the finest level is drawn"},
    GltfExtension{"MSFT_packing_normalRoughnessMetallic", kNoEffect, "the unpacked textures are drawn"},
    GltfExtension{"MSFT_packing_occlusionRoughnessMetallic", kNoEffect, "the unpacked textures are drawn"},
    GltfExtension{"MSFT_texture_dds", kApproximated, "the texture's other image, else the DDS image if it can be read"},
    GltfExtension{"NV_materials_mdl", kIgnored, "the glTF material is drawn"},
    GltfExtension{"OMI_physics_body", kNoEffect, "the scene is drawn as it starts"},
    GltfExtension{"OMI_physics_shape", kNoEffect, "shapes of colliders"},
    GltfExtension{"VRM", kNoEffect, "the model is drawn at rest, with its glTF materials"},
    GltfExtension{"VRMC_materials_mtoon", kIgnored, "the glTF material is drawn"},
    GltfExtension{"VRMC_node_constraint", kNoEffect, "the model is drawn at rest"},
    GltfExtension{"VRMC_springBone", kNoEffect, "the model is drawn at rest"},
    GltfExtension{"VRMC_vrm", kNoEffect, "the model is drawn at rest"},
};

}  // namespace

std::span<const GltfExtension> gltf_extensions() { return kExtensions; }

std::string_view support_name(GltfSupport support) {
    switch (support) {
        case kDrawn:
            return "drawn";
        case kApproximated:
            return "approximated";
        case kNoEffect:
            return "no effect";
        case kIgnored:
            return "ignored";
        case kRefused:
            return "refused";
    }
    return "";
}

}  // namespace pellucid
