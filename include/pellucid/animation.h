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
    std::string name;          ///< the file's; "animation N" where it has none
    double duration_s = 0.0;   ///< time of the last keyframe
    std::vector<int> meshes;   ///< Scene::meshes whose vertices it moves (skins and morph targets)
    std::vector<int> objects;  ///< Scene::objects that it moves as a whole
};

/// Animations of the scene's file, in the file's order; none for files other than glTF.
PELLUCID_API std::vector<AnimationInfo> animations(const Scene& scene);

/// Index of the animation of that name, or else of that number ("2"). Throws Error listing the known ones.
PELLUCID_API std::size_t find_animation(const Scene& scene, std::string_view name_or_number);

/// Vertices of one mesh in a pose.
struct PosedMesh {
    int mesh = 0;  ///< Scene::meshes
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;  ///< unit
};
/// Placement of one object in a pose.
struct PosedObject {
    int object = 0;                     ///< Scene::objects
    glm::mat4 world_from_object{1.0f};  ///< affine, about Scene::origin; not invertible where scaled to nothing
};

/// A scene at one time of an animation: everything that any of the file's animations moves. So a pose does not
/// depend on the one before, and animations may change from frame to frame.
struct Pose {
    std::vector<PosedMesh> meshes;
    std::vector<PosedObject> objects;
    /// For Renderer::set_positions() or Tracer::set_positions(). Refers to this pose, which must stay alive.
    PELLUCID_API std::vector<MovedMesh> moved_meshes() const;
};

/// The scene at a time from 0 (s), which clamps to the ends of the animation. Vertices are as many as the scene's
/// meshes have, in the same order, so that they can go to Renderer::set_positions(); those of skinned meshes are in
/// the world's frame, where their objects stand at the identity. Meshes and objects of the scene must be those that
/// load_scene() made; more may be appended.
///
/// On the CPU, single-threaded; the cost grows with the vertices moved, their morph targets and joints.
/// Throws Error if there is no such animation, the time is negative or not finite, the scene's meshes were changed,
/// or numbers become too large.
PELLUCID_API Pose pose_at(const Scene& scene, std::size_t animation, double time_s);

}  // namespace pellucid
