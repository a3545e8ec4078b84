#pragma once

#include <pellucid/api.h>
#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// One animation of a scene's file.
struct AnimationInfo {
    std::string name;          ///< name in the file; "animation N" for an unnamed one
    double duration_s = 0.0;   ///< time of the last keyframe
    std::vector<int> meshes;   ///< indices into Scene::meshes: meshes whose vertices it moves (skins and morph targets)
    std::vector<int> objects;  ///< indices into Scene::objects: objects that it moves as a whole
};

/// Animations of the scene's file, in the file's order. Only glTF files have animations.
PELLUCID_API std::vector<AnimationInfo> animations(const Scene& scene);

/// Index of the animation with this name, or else with this number ("2"). Throws Error listing the known animations.
PELLUCID_API std::size_t find_animation(const Scene& scene, std::string_view name_or_number);

/// Vertices of one mesh in a pose.
struct PosedMesh {
    int mesh = 0;  ///< index into Scene::meshes
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;  ///< unit length
};
/// Placement of one object in a pose.
struct PosedObject {
    int object = 0;  ///< index into Scene::objects
    /// affine, relative to Scene::origin; singular where an animation scales the object to zero
    glm::mat4 world_from_object{1.0f};
};

/// A scene at one time of an animation. It contains everything that any animation of the file moves. Poses are
/// therefore independent of each other, and the animation may change from frame to frame.
struct Pose {
    std::vector<PosedMesh> meshes;
    std::vector<PosedObject> objects;
    /// Arguments for Renderer::set_positions() or Tracer::set_positions(). They refer to this pose, which must stay
    /// alive.
    PELLUCID_API std::vector<MovedMesh> moved_meshes() const;
};

/// The scene at `time_s`, in seconds from 0; later times clamp to the end of the animation. Vertices have the count
/// and order of the scene's meshes, so they can go to Renderer::set_positions(). Vertices of skinned meshes are in
/// world space, where their objects have the identity transform. The scene must keep the meshes and objects of
/// load_scene(); more may be appended.
///
/// Runs on the CPU, on one thread. The cost grows with the vertices moved, their morph targets and joints. Throws
/// Error if the animation does not exist, the time is negative or not finite, the scene's meshes were changed, or
/// numbers become too large.
PELLUCID_API Pose pose_at(const Scene& scene, std::size_t animation, double time_s);

}  // namespace pellucid
