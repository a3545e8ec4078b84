#include "fuzz/fuzz_target.h"

#include "lab/dataset_recipe.h"

#include <pellucid/animation.h>
#include <pellucid/environment.h>

#include <algorithm>
#include <stdexcept>

namespace pellucid::test {
namespace {

void expect(bool promise, const std::string& what) {
    if (!promise) throw std::logic_error(what);
}

void expect_promises(const Scene& scene) { expect(broken_promise(scene).empty(), broken_promise(scene)); }

void load_mesh(const std::string& file) { expect_promises(load_scene(file)); }

/// At rest, and in the first animations.
void load_gltf(const std::string& file) {
    constexpr std::size_t kMostAnimations = 4;
    const Scene scene = load_scene(file);
    expect_promises(scene);
    const std::size_t count = std::min(animations(scene).size(), kMostAnimations);
    for (std::size_t animation = 0; animation < count; ++animation) {
        Scene posed = scene;
        const Pose pose = pose_at(scene, animation, 1.7);
        for (const PosedMesh& mesh : pose.meshes) {
            posed.meshes.at(std::size_t(mesh.mesh)).positions = mesh.positions;
            posed.meshes.at(std::size_t(mesh.mesh)).normals = mesh.normals;
        }
        expect_promises(posed);
    }
}

/// By an OBJ file with two materials.
void load_mtl(const std::string& file) {
    const std::filesystem::path obj = std::filesystem::path(file).replace_extension(".obj");
    if (!std::filesystem::exists(obj)) {
        write_image(std::filesystem::path(file).replace_filename("a.png"), Image(4, 4, 4));
        std::ofstream(obj) << "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 1\nusemtl a\n"
                              "f 1/1 3/2 2/1\nf 1/2 2/1 4/1\nusemtl b\nf 2 3 4\nf 1 4 3\n";
    }
    load_mesh(obj.string());
}

void load_map(const std::string& file) {
    const Environment environment = load_environment(file);
    const Image& map = environment.map;
    expect(map.pixels.size() == std::size_t(map.width) * std::size_t(map.height) * std::size_t(map.channels),
           "size of the map");
    expect(std::all_of(map.pixels.begin(), map.pixels.end(), [](float x) { return x >= 0.0f && std::isfinite(x); }),
           "texel of the map");
}

void load_vdb(const std::string& file) {
    const Volume volume = load_volume(file, {});
    expect(volume.voxel > 0.0f && volume.voxel_count() > 0, "size of the volume");
}

void load_recipe(const std::string& file) {
    const cli::Recipe recipe = cli::read_recipe(file);
    expect(recipe.width >= 8 && recipe.height >= 8 && recipe.images >= 1, "numbers of the recipe");
}

constexpr FuzzTarget kTargets[] = {
    {"gltf", "a.gltf", load_gltf}, {"glb", "a.glb", load_gltf}, {"obj", "a.obj", load_mesh},
    {"mtl", "a.mtl", load_mtl},    {"ply", "a.ply", load_mesh}, {"stl", "a.stl", load_mesh},
    {"off", "a.off", load_mesh},   {"3ds", "a.3ds", load_mesh}, {"hdr", "a.hdr", load_map},
    {"exr", "a.exr", load_map},    {"vdb", "a.vdb", load_vdb},  {"recipe", "a.json", load_recipe},
};

}  // namespace

std::span<const FuzzTarget> reader_targets() { return kTargets; }

}  // namespace pellucid::test
