#include "gpu/scene_topology.h"

#include "scene/mesh_repair.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace pellucid {
namespace {

/// Twin of ObjectBox in follow_paths.comp.
struct ObjectBox {
    glm::vec3 low;
    float radius;  ///< from the middle of the box to the farthest vertex
    glm::vec3 high;
    float reserved;
};
static_assert(sizeof(ObjectBox) == 32);

struct Box {
    glm::vec3 low{std::numeric_limits<float>::max()};
    glm::vec3 high{std::numeric_limits<float>::lowest()};

    double volume() const {
        const glm::dvec3 size = glm::dvec3(high) - glm::dvec3(low);
        return size.x * size.y * size.z;
    }
};

Box box_of(const Mesh& mesh, const glm::mat4& world_from_object) {
    Box box;
    for (const glm::vec3& p : mesh.positions) {
        const glm::vec3 world(world_from_object * glm::vec4(p, 1.0f));
        box.low = glm::min(box.low, world);
        box.high = glm::max(box.high, world);
    }
    return box;
}

bool meet(const Box& a, const Box& b) {
    // A few roundings of a coordinate apart still counts as touching.
    const float apart = 1e-6f * std::max({glm::length(a.low), glm::length(a.high), glm::length(b.high)});
    return glm::all(glm::lessThanEqual(a.low - apart, b.high)) && glm::all(glm::lessThanEqual(b.low - apart, a.high));
}

/// Liquid displaces the goblet that it overlaps, a bubble the block around it: the smaller box wins.
std::vector<std::uint32_t> rank_by_size(const std::vector<Box>& boxes, const std::vector<std::uint32_t>& solids) {
    std::vector<std::uint32_t> order = solids;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return boxes[a].volume() > boxes[b].volume(); });
    std::vector<std::uint32_t> rank(boxes.size(), 0);
    for (std::uint32_t i = 0; i < order.size(); ++i) rank[order[i]] = i;
    return rank;
}

}  // namespace

SceneTopology::SceneTopology(const Device& device, const Scene& scene) {
    for (const Mesh& mesh : scene.meshes)
        closed_.push_back(count_edges(mesh.triangles, weld_positions(mesh.positions)).closed());
    const auto usage = vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst;
    const std::size_t count = std::max<std::size_t>(scene.objects.size(), 1);
    traits = Buffer(device, "the objects' traits", count * 4, usage);
    materials = Buffer(device, "the solids' materials", count * 4, usage);
    boxes = Buffer(device, "the objects' boxes", count * sizeof(ObjectBox), usage);
    update(device, scene, 0);
}

void SceneTopology::update(const Device& device, const Scene& scene, std::uint64_t moves_now) {
    std::vector<Box> own_boxes;
    std::vector<ObjectBox> uploaded;
    std::vector<std::uint32_t> refracting;
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        const Box box = box_of(scene.meshes[std::size_t(object.mesh)], object.world_from_object);
        own_boxes.push_back(box);
        const glm::vec3 middle = 0.5f * (box.low + box.high);
        float radius = 0.0f;
        for (const glm::vec3& p : scene.meshes[std::size_t(object.mesh)].positions)
            radius = std::max(radius, glm::distance(middle, glm::vec3(object.world_from_object * glm::vec4(p, 1.0f))));
        uploaded.push_back({box.low, radius, box.high, 0.0f});
        if (scene.materials[std::size_t(object.material)].refractive()) refracting.push_back(i);
    }
    const std::vector<std::uint32_t> rank = rank_by_size(own_boxes, refracting);
    solids = std::uint32_t(refracting.size());
    all_alone = true;
    std::vector<std::uint32_t> words, by_rank(std::max<std::size_t>(refracting.size(), 1), 0);
    for (const std::uint32_t i : refracting) by_rank[rank[i]] = std::uint32_t(scene.objects[i].material);
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        const Material& material = scene.materials[std::size_t(object.material)];
        bool touches = false;
        for (std::uint32_t k = 0; k < own_boxes.size() && !touches; ++k)
            touches = k != i && meet(own_boxes[i], own_boxes[k]);
        all_alone = all_alone && !touches;
        const std::uint32_t kind = material.refractive() ? 2u : material.transmissive() ? 1u : 0u;
        words.push_back(kind | (closed_[std::size_t(object.mesh)] ? 4u : 0u) | (touches ? 8u : 0u) |
                        (material.alpha_cutoff > 0.0f ? 16u : 0u) | rank[i] << 8);
    }
    upload(device, traits, std::as_bytes(std::span(words)));
    upload(device, materials, std::as_bytes(std::span(by_rank)));
    trait_words_ = std::move(words);
    material_words_ = std::move(by_rank);
    if (!uploaded.empty()) upload(device, boxes, std::as_bytes(std::span(uploaded)));
    moves = moves_now;
}

void SceneTopology::mark_replaced(const Device& device, const std::vector<int>& objects) {
    constexpr std::uint32_t kReplaced = 32, kReplacedSolid = 0x80000000;  // twins in object_traits.glsl
    std::vector<std::uint32_t> words = trait_words_, by_rank = material_words_;
    for (const int object : objects) {
        std::uint32_t& word = words[std::size_t(object)];
        word |= kReplaced;
        by_rank[word >> 8] |= kReplacedSolid;
    }
    upload(device, traits, std::as_bytes(std::span(words)));
    upload(device, materials, std::as_bytes(std::span(by_rank)));
}

}  // namespace pellucid
