#include "viewer/stage.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace pellucid::viewer {
namespace {

/// Resets placements and vertices of the pose to the scene at rest.
void rest(const Scene& scene, Pose& pose) {
    for (PosedObject& object : pose.objects)
        object.world_from_object = scene.objects[std::size_t(object.object)].world_from_object;
    for (PosedMesh& mesh : pose.meshes) {
        mesh.positions = scene.meshes[std::size_t(mesh.mesh)].positions;
        mesh.normals = scene.meshes[std::size_t(mesh.mesh)].normals;
    }
}

}  // namespace

bool Stage::apply(const Document& document, const std::function<void()>& before_scene) {
    bool changed = apply_scene(document, before_scene);
    changed |= apply_materials(document.look);
    changed |= apply_lights(document.look);
    changed |= apply_pose(document);
    changed |= apply_environment(document);
    if (changed || !applied_ || !(applied_->camera == document.look.camera) ||
        applied_->file_camera != document.look.file_camera) {
        camera_ = camera_of(document.look, document.scene(), document.bounds());
        renderer_.set_camera(camera_);
        changed = true;
    }
    applied_ = document.look;
    return changed;
}

bool Stage::apply_scene(const Document& document, const std::function<void()>& before_scene) {
    if (scene_number_ == document.scene_number()) return false;
    before_scene();
    scene_number_ = 0;  // a renderer that fails to set a scene has none
    renderer_.set_scene(document.scene());
    scene_ = document.scene();
    scene_number_ = document.scene_number();
    applied_.reset();
    return true;
}

bool Stage::apply_materials(const Look& look) {
    bool changed = false;
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
        if (look_of(scene_.materials[i]) == look.materials[i]) continue;
        viewer::apply(look.materials[i], scene_.materials[i]);
        renderer_.set_material(int(i), scene_.materials[i]);
        changed = true;
    }
    return changed;
}

bool Stage::apply_lights(const Look& look) {
    bool changed = false;
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
        if (look_of(scene_.lights[i]) == look.lights[i]) continue;
        viewer::apply(look.lights[i], scene_.lights[i]);
        renderer_.set_light(int(i), scene_.lights[i]);
        changed = true;
    }
    return changed;
}

/// Moves the scene to the pose of the look, or back to rest.
bool Stage::apply_pose(const Document& document) {
    const Look& look = document.look;
    const std::optional<std::size_t> before = applied_ ? applied_->animation : std::nullopt;
    if (before == look.animation && (!look.animation || (applied_ && applied_->time_s == look.time_s))) return false;
    Pose pose = pose_at(document.scene(), look.animation.value_or(0), look.animation ? look.time_s : 0.0);
    if (!look.animation) rest(document.scene(), pose);
    std::erase_if(pose.objects, [&](const PosedObject& each) {
        return std::exchange(scene_.objects[std::size_t(each.object)].world_from_object, each.world_from_object) ==
               each.world_from_object;
    });
    // Objects with a singular transform have no inverse; they keep their last placement.
    std::erase_if(pose.objects, [](const PosedObject& each) {
        return !(std::abs(glm::determinant(glm::mat3(each.world_from_object))) > 0.0f);
    });
    if (!pose.objects.empty()) renderer_.set_transforms(pose.objects);
    if (!pose.meshes.empty()) renderer_.set_positions(pose.moved_meshes());
    for (PosedMesh& mesh : pose.meshes) {
        scene_.meshes[std::size_t(mesh.mesh)].positions = std::move(mesh.positions);
        scene_.meshes[std::size_t(mesh.mesh)].normals = std::move(mesh.normals);
    }
    return true;
}

bool Stage::apply_environment(const Document& document) {
    const Look& look = document.look;
    const auto rotation = float(glm::radians(std::remainder(look.environment_rotation_deg, 360.0)));
    const auto intensity = float(look.environment_intensity);
    if (environment_number_ != document.environment_number()) {
        Environment environment = document.environment();
        environment.rotation = rotation;
        environment.intensity = intensity;
        renderer_.set_environment(environment);
        environment_number_ = document.environment_number();
        turned_ = {rotation, intensity};
        return true;
    }
    if (turned_ == std::pair(rotation, intensity)) return false;
    renderer_.turn_environment(rotation, intensity);
    turned_ = {rotation, intensity};
    return true;
}

}  // namespace pellucid::viewer
