#pragma once

#include "gpu/memory.h"
#include "scene/bodies.h"

#include <pellucid/scene.h>

#include <cstdint>
#include <vector>

namespace pellucid {

/// Data of a scene, besides GpuScene, for techniques that follow rays through its triangles.
///
/// A path has a bit per slot: whether it is inside a shell of that slot. Closed shells of a body that may overlap have
/// separate slots; shells that never overlap share one. A body's winding number is the sum over its slots. A shell that
/// crosses itself has consecutive slots, one for each step of its winding number.
struct SceneTopology {
    Buffer traits;        ///< per object, see object_traits.glsl
    Buffer shell_traits;  ///< per triangle of every mesh, added to the object's traits; empty if !many_slots
    Buffer slots;         ///< SlotRecord[]
    Buffer boxes;         ///< ObjectBox[], see follow_paths.glsl
    Buffer eye;           ///< a bit per slot: whether the eye is inside of it, see look_from()
    std::uint32_t slot_count = 0;
    bool many_slots = false;           ///< a body has several slots
    bool crossing = false;             ///< a shell crosses itself
    std::size_t with_inner_walls = 0;  ///< number of bodies whose shells may overlap or cross themselves
    bool all_alone = true;             ///< no two surfaces coincide
    bool eye_in_solid = false;         ///< the eye is inside a solid, see look_from()
    bool eye_differs = false;          ///< rays may start in different solids, see look_from()
    float eye_depth = 0.0f;            ///< depth of the plane on which rays start, m
    float largest_contact = 0.0f;      ///< largest contact distance of any ObjectBox, m
    std::uint64_t moves = 0;           ///< GpuScene::moves at the last update

    SceneTopology(const Device& device, const Scene& scene);
    /// Updates the topology after vertices have moved. Closed shells stay closed, and bodies keep their ranks.
    void update(const Device& device, const Scene& scene, std::uint64_t moves);
    /// Marks exactly these objects as replaced by volumes. Techniques that draw no volumes ignore the mark.
    void mark_replaced(const Device& device, const std::vector<int>& objects);
    /// Finds the solids that the eye is in by solid angles (van Oosterom & Strackee 1983). With an orthographic camera
    /// or a near plane, rays start at different points. Then every ray finds its own solids if a box reaches its start.
    void look_from(const Device& device, const Scene& scene, const Camera& camera);
    /// Contents of `traits`, `shell_traits` and `slots`, without the marks of mark_replaced().
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
        std::uint32_t open = 0;            ///< slot of its open shells, if any
        std::vector<std::uint32_t> words;  ///< per shell, added to the traits of its objects
    };
    std::vector<BodySlots> body_slots_;  ///< per body
    std::vector<std::uint32_t> trait_words_, slot_words_;
    std::vector<std::uint32_t> shell_words_;  ///< per triangle of every mesh
    std::vector<Box> boxes_, body_boxes_;     ///< per object and per body, world
    std::vector<std::uint32_t> eye_bits_;     ///< contents of `eye`
};

}  // namespace pellucid
