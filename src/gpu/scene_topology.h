#pragma once

#include "gpu/memory.h"
#include "scene/bodies.h"

#include <pellucid/scene.h>

#include <cstdint>
#include <vector>

namespace pellucid {

/// What techniques that follow rays through a scene's triangles know of it besides GpuScene.
///
/// A path keeps a bit for each slot: whether it is inside a shell of that slot. Closed shells of a body that may overlap
/// have slots of their own, shells that never do share one; a body's winding number is the sum over its slots. A shell
/// that crosses itself has a slot for each step of its winding number, one after the other.
struct SceneTopology {
    Buffer traits;        ///< per object, see object_traits.glsl
    Buffer shell_traits;  ///< per triangle of every mesh, what is added to its object's; empty if !many_slots
    Buffer slots;         ///< SlotRecord[]
    Buffer boxes;         ///< ObjectBox[], see follow_paths.comp
    Buffer eye;           ///< a bit per slot: what the eye is inside of, see look_from()
    std::uint32_t slot_count = 0;
    bool many_slots = false;           ///< some body has several
    bool crossing = false;             ///< some shell crosses itself
    std::size_t with_inner_walls = 0;  ///< bodies whose shells may overlap or cross themselves
    bool all_alone = true;             ///< no two surfaces lie at one place
    bool eye_in_solid = false;         ///< see look_from()
    bool eye_differs = false;          ///< from ray to ray
    float eye_depth = 0.0f;            ///< m, of the plane on which rays start
    float largest_contact = 0.0f;      ///< of any ObjectBox, m
    std::uint64_t moves = 0;           ///< GpuScene::moves that the traits are of

    SceneTopology(const Device& device, const Scene& scene);
    /// Where vertices have moved. Shells that are closed stay so, and so does who displaces whom.
    void update(const Device& device, const Scene& scene, std::uint64_t moves);
    /// Marks objects for which volumes stand; all others are not. Techniques that draw no volumes look past the mark.
    void mark_replaced(const Device& device, const std::vector<int>& objects);
    /// Finds the solids that the eye is in, by solid angles (van Oosterom & Strackee 1983). Rays that do not all start at
    /// one point, of an orthographic camera or at a near plane, find their own where there are solids.
    void look_from(const Device& device, const Scene& scene, const Camera& camera);
    /// What `traits`, `shell_traits` and `slots` hold, but for marks.
    const std::vector<std::uint32_t>& trait_words() const { return trait_words_; }
    const std::vector<std::uint32_t>& shell_words() const { return shell_words_; }
    const std::vector<std::uint32_t>& slot_words() const { return slot_words_; }

private:
    struct Box {
        glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
    };
    void number_slots(const Scene& scene);

    Bodies bodies_;
    struct BodySlots {
        std::uint32_t closed = 0;          ///< first slot of its closed shells
        std::uint32_t open = 0;            ///< slot of its open ones, if there are any
        std::vector<std::uint32_t> words;  ///< per shell, what is added to the traits of its objects
    };
    std::vector<BodySlots> body_slots_;  ///< per body
    std::vector<std::uint32_t> trait_words_, slot_words_;
    std::vector<std::uint32_t> shell_words_;  ///< per triangle of every mesh
    std::vector<Box> boxes_, body_boxes_;     ///< per object and per body, world
    std::vector<std::uint32_t> eye_bits_;     ///< what `eye` holds
};

}  // namespace pellucid
