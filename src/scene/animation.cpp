#include <pellucid/animation.h>

#include <pellucid/error.h>
#include <pellucid/names.h>

#include "scene/animation_names.h"
#include "scene/deform_mesh.h"
#include "scene/pose_nodes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>

namespace pellucid {
namespace {

const std::vector<Animation>& animations_of(const Scene& scene) {
    static const std::vector<Animation> kNone;
    return scene.rig ? scene.rig->animations : kNone;
}

PosedMesh posed(const Scene& scene, const DeformedMesh& mesh, const NodePose& pose) {
    const Mesh* const shown =
        std::size_t(mesh.mesh) < scene.meshes.size() ? &scene.meshes[std::size_t(mesh.mesh)] : nullptr;
    if (!shown || shown->positions.size() != scene.rig->shapes[mesh.shape].base.positions.size())
        throw Error(fmt::format("{}: mesh {} is not the one that was loaded", scene.source, mesh.mesh));
    DeformedVertices vertices = deform(*scene.rig, mesh, pose);
    if (!vertices.finite())
        throw Error(fmt::format("{}: {}: a position is not finite in this pose", scene.source, shown->name));
    return {mesh.mesh, std::move(vertices.positions), std::move(vertices.normals)};
}

}  // namespace

std::size_t find_animation(const std::vector<Animation>& animations, std::string_view name, const std::string& source) {
    std::vector<std::string_view> known;
    for (std::size_t i = 0; i < animations.size(); ++i) {
        if (animations[i].name == name) return i;
        known.push_back(animations[i].name);
    }
    if (known.empty()) throw Error(fmt::format("{}: has no animations", source));
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error == std::errc() && end == name.data() + name.size() && number < animations.size()) return number;
    throw Error(fmt::format("{}: {}", source, unknown_name("animation", name, known).what()));
}

void check_animation_time(double time_s) {
    if (!(time_s >= 0.0 && std::isfinite(time_s)))
        throw Error(fmt::format("animation time {}: must be a number from 0, in seconds", time_s));
}

std::vector<AnimationInfo> animations(const Scene& scene) {
    std::vector<AnimationInfo> infos;
    for (const Animation& animation : animations_of(scene)) {
        AnimationInfo& info = infos.emplace_back();
        info.name = animation.name;
        info.duration_s = animation.duration_s();
        const std::vector<char> moved = moved_nodes(scene.rig->tree, animation);
        for (const DeformedMesh& mesh : scene.rig->meshes)
            if (moves(*scene.rig, animation, moved, mesh)) info.meshes.push_back(mesh.mesh);
        for (const NodeObject& object : scene.rig->objects)
            if (moved[std::size_t(object.node)]) info.objects.push_back(object.object);
    }
    return infos;
}

std::size_t find_animation(const Scene& scene, std::string_view name_or_number) {
    return find_animation(animations_of(scene), name_or_number, scene.source);
}

std::vector<MovedMesh> Pose::moved_meshes() const {
    std::vector<MovedMesh> moved;
    for (const PosedMesh& mesh : meshes) moved.push_back({mesh.mesh, mesh.positions, mesh.normals});
    return moved;
}

Pose pose_at(const Scene& scene, std::size_t animation, double time_s) {
    check_animation_time(time_s);
    const std::vector<Animation>& known = animations_of(scene);
    if (animation >= known.size())
        throw Error(fmt::format("{}: there is no animation {}, there are {}", scene.source, animation, known.size()));
    NodePose nodes = pose_nodes(scene.rig->tree, &known[animation], time_s);
    rebase(nodes, scene.origin);
    Pose pose;
    for (const DeformedMesh& mesh : scene.rig->meshes) pose.meshes.push_back(posed(scene, mesh, nodes));
    for (const NodeObject& object : scene.rig->objects)
        pose.objects.push_back({object.object, world_from_object(nodes, object)});
    return pose;
}

}  // namespace pellucid
