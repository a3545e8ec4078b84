#include <pellucid/error.h>
#include <pellucid/file.h>
#include <pellucid/scene.h>

#include "core/fail.h"
#include "core/math.h"
#include "scene/animation_names.h"
#include "scene/attenuation_hints.h"
#include "scene/far_positions.h"
#include "scene/glass_scene.h"
#include "scene/load_gltf.h"
#include "scene/load_mesh_file.h"
#include "scene/mesh_tangents.h"
#include "scene/rig.h"
#include "scene/shapes.h"
#include "scene/translucency.h"
#include "scene/volumes/volume_source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace pellucid {
namespace {

constexpr std::string_view kShapePrefix = "shape:";
constexpr std::array<std::string_view, 5> kMeshExtensions = {".obj", ".ply", ".stl", ".off", ".3ds"};

void check(const LoadOptions& options) {
    if (options.ior && !(*options.ior >= 1.0f && std::isfinite(*options.ior)))
        throw Error(fmt::format("ior {}: must be a number from 1", *options.ior));
    if (options.attenuation_color) {
        const glm::vec3 c = *options.attenuation_color;
        for (int k = 0; k < 3; ++k)
            if (!(c[k] >= 0.0f && c[k] <= 1.0f))
                throw Error(fmt::format("attenuation colour {} {} {}: must be within 0..1", c.x, c.y, c.z));
    }
    if (options.attenuation_distance && !(*options.attenuation_distance > 0.0f))
        throw Error(fmt::format("attenuation distance {}: must be greater than 0", *options.attenuation_distance));
    if (options.translucent) check_translucency(*options.translucent);  // before anything is read
    const bool angle = options.crease_angle >= 0.0f && options.crease_angle <= kPi;
    if (!angle && options.crease_angle != kCreasesByShell)
        throw Error(fmt::format("crease angle {}: must be within 0..pi radians", options.crease_angle));
    if (options.time_s) check_animation_time(*options.time_s);
}

Scene volume_scene(Volume volume) {
    Scene scene;
    scene.origin = frame_origin({.low = volume.low, .high = volume.high()});
    volume.low = glm::dvec3(volume.low) - scene.origin;
    VolumeObject object;
    object.name = volume.name;
    scene.volume_objects.push_back(std::move(object));
    scene.volumes.push_back(std::make_shared<const Volume>(std::move(volume)));
    return scene;
}

Scene load_by_kind(const std::string& source, const LoadOptions& options, Warnings& warnings) {
    const std::filesystem::path file(source);
    const std::string extension = lower_extension(file);
    const bool shape = source.starts_with(kShapePrefix), volume = names_volume(source) && !shape;
    const bool gltf = !shape && !volume && (extension == ".gltf" || extension == ".glb");
    if (!gltf && (options.animation || options.time_s)) fail(source, "has no animations");
    if (volume) return volume_scene(open_volume(source, {.folder = {}, .allow_outside = true}, options.grids));
    if (!options.grids.empty()) fail(source, "has no grids; those of .vdb files are mapped to fields");
    if (shape)
        // A shape knows its normals exactly; made ones would only be worse.
        return glass_scene(load_shape(source.substr(kShapePrefix.size())), options, true, warnings);
    if (gltf) return load_gltf(file, options, warnings);
    if (std::find(kMeshExtensions.begin(), kMeshExtensions.end(), extension) != kMeshExtensions.end())
        return load_mesh_file(file, options, warnings);
    fail(file, fmt::format("unknown kind of file \"{}\" (known: .gltf, .glb, .vdb, {}, shape:NAME or volume:NAME)",
                           extension, fmt::join(kMeshExtensions, ", ")));
}

void apply_overrides(Scene& scene, const LoadOptions& options) {
    for (Material& material : scene.materials) {
        if (!material.refractive()) continue;
        if (options.ior) material.ior = *options.ior;
        if (options.attenuation_color) material.attenuation_color = *options.attenuation_color;
        if (options.attenuation_distance) material.attenuation_distance = *options.attenuation_distance;
    }
}

void apply_priorities(const std::string& source, Scene& scene, const LoadOptions& options) {
    for (const LoadOptions::Priority& given : options.priorities) {
        bool found = false;
        std::set<std::string> known;
        for (Object& object : scene.objects) {
            known.insert(object.name);
            if (object.name != given.object) continue;
            object.priority = given.priority;
            found = true;
        }
        if (!found)
            fail(source,
                 fmt::format("priority: there is no object \"{}\" (known: {})", given.object, fmt::join(known, ", ")));
    }
}

/// One per mesh: the scene's animations deform it.
std::vector<char> deforming_meshes(const Scene& scene) {
    std::vector<char> deforming(scene.meshes.size(), 0);
    if (scene.rig)
        for (const DeformedMesh& mesh : scene.rig->meshes) deforming[std::size_t(mesh.mesh)] = 1;
    return deforming;
}

}  // namespace

Scene load_scene(const std::string& source, const LoadOptions& options) {
    check(options);
    Warnings warnings;
    Scene scene = load_by_kind(source, options, warnings);
    scene.source = source;
    apply_overrides(scene, options);
    apply_priorities(source, scene, options);
    if (options.translucent) make_translucent(scene, *options.translucent);
    add_tangents(scene, deforming_meshes(scene), warnings);
    if (scene.triangle_count() == 0 && scene.volume_objects.empty()) fail(source, "contains no triangles");
    const Bounds bounds = scene_bounds(scene);
    // Squares and products of positions must stay finite on the GPU, in 32 bits.
    constexpr float kLargest = 1e15f, kSmallest = 1e-15f;
    if (!(glm::length(glm::dvec3(bounds.center) + scene.origin) < double(kLargest) && bounds.radius < kLargest))
        fail(source, "positions are too large (more than 1e15)");
    if (!(bounds.radius > kSmallest)) fail(source, "all positions are the same");
    hint_at_units(scene, warnings);
    scene.warnings = warnings.lines();
    return scene;
}

}  // namespace pellucid
