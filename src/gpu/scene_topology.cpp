#include "gpu/scene_topology.h"

#include "scene/orient_shells.h"
#include "scene/shell_windings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <tuple>
#include <utility>

namespace pellucid {
namespace {

/// Twin of ObjectBox in follow_paths.glsl.
struct ObjectBox {
    glm::vec3 low;
    float radius;  ///< from the middle of the box to the farthest vertex
    glm::vec3 high;
    float contact;  ///< surfaces no farther apart are at one place, m
};
static_assert(sizeof(ObjectBox) == 32);

/// Twin of SlotRecord in object_traits.glsl.
struct SlotRecord {
    std::uint32_t material, first, count, medium;
};

// Twins in object_traits.glsl.
constexpr std::uint32_t kClosed = 4, kTouches = 8, kCutOut = 16, kReplaced = 32, kCavity = 64, kSingleSided = 128,
                        kCrossesItself = 256, kSlotShift = 9;
constexpr std::uint32_t kReplacedSolid = 0x80000000, kCavitySlot = 0x80000000, kReplacedMedium = 0x40000000,
                        kSameShell = 0x20000000;

constexpr float kContact = 1e-6f;  ///< of a body's extent

template <class Box>
bool meet(const Box& a, const Box& b, float apart) {
    return glm::all(glm::lessThanEqual(a.low - apart, b.high)) && glm::all(glm::lessThanEqual(b.low - apart, a.high));
}

struct ShellBox {
    glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
    bool cavity = false;
};

/// Which shells of a surface share slots, in numbers from 0. A colour has a slot for each step of its winding number.
struct Coloring {
    std::vector<std::uint32_t> color;  ///< per shell; of open ones 0
    std::vector<WindingRange> range;   ///< per colour
    bool any_open = false;

    std::uint32_t first_slot(std::uint32_t of_color) const {
        std::uint32_t first = 0;
        for (std::uint32_t c = 0; c < of_color; ++c) first += std::uint32_t(range[c].most - range[c].least);
        return first;
    }
    std::uint32_t slot_count() const { return first_slot(std::uint32_t(range.size())); }
};

constexpr WindingRange kOutward{0, 1}, kInward{-1, 0};

std::vector<ShellBox> shell_boxes(const BodySurface& surface) {
    std::vector<ShellBox> boxes(surface.shells.count());
    std::vector<double> volume(surface.shells.count(), 0.0);
    const glm::dvec3 origin = surface.positions.empty() ? glm::dvec3(0.0) : glm::dvec3(surface.positions.front());
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const std::uint32_t shell = surface.shells.of_triangle[t];
        glm::dvec3 p[3];
        for (int k = 0; k < 3; ++k) {
            const glm::vec3 corner = surface.positions[surface.triangles[t][k]];
            boxes[shell].low = glm::min(boxes[shell].low, corner);
            boxes[shell].high = glm::max(boxes[shell].high, corner);
            p[k] = glm::dvec3(corner) - origin;
        }
        volume[shell] += glm::dot(p[0], glm::cross(p[1], p[2]));
    }
    for (std::size_t s = 0; s < boxes.size(); ++s) boxes[s].cavity = volume[s] < 0.0;
    return boxes;
}

/// Shells whose boxes meet, of each closed shell. Swept along x.
std::vector<std::vector<std::uint32_t>> meeting_shells(const std::vector<ShellBox>& boxes, const Shells& shells) {
    float extent = 0.0f;
    for (const ShellBox& box : boxes) {
        const glm::vec3 size = box.high - box.low;
        extent = std::max({extent, size.x, size.y, size.z, glm::length(box.low), glm::length(box.high)});
    }
    const float apart = 4.0f * kContact * extent;
    std::vector<std::uint32_t> order;
    for (std::uint32_t s = 0; s < shells.count(); ++s)
        if (shells.closed[s] != 0) order.push_back(s);
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return boxes[a].low.x < boxes[b].low.x; });
    std::vector<std::vector<std::uint32_t>> meeting(shells.count());
    for (std::size_t i = 0; i < order.size(); ++i) {
        for (std::size_t k = i + 1; k < order.size() && boxes[order[k]].low.x - apart <= boxes[order[i]].high.x; ++k) {
            if (!meet(boxes[order[i]], boxes[order[k]], apart)) continue;
            meeting[order[i]].push_back(order[k]);
            meeting[order[k]].push_back(order[i]);
        }
    }
    return meeting;
}

/// Greedily: no two shells that meet have one colour, but for cavities in a shell that meet nothing else.
Coloring color_shells(const BodySurface& surface) {
    const Shells& shells = surface.shells;
    Coloring coloring;
    coloring.color.assign(shells.count(), 0);
    coloring.any_open = !shells.all_closed();
    std::vector<WindingRange> ranges = winding_ranges(surface.positions, surface.triangles, shells);
    if (shells.count() == 1) {
        if (shells.all_closed()) coloring.range.push_back(ranges[0].crosses_itself() ? ranges[0] : kOutward);
        return coloring;
    }
    std::vector<ShellBox> boxes = shell_boxes(surface);
    const std::vector<std::vector<std::uint32_t>> meeting = meeting_shells(boxes, shells);
    std::vector<std::uint32_t> around(shells.count(), shells.count());  // of cavities that go with a shell
    for (std::uint32_t s = 0; s < shells.count(); ++s) {
        if (ranges[s].crosses_itself()) continue;
        ranges[s] = boxes[s].cavity ? kInward : kOutward;
        if (!boxes[s].cavity || meeting[s].size() != 1) continue;
        const std::uint32_t outer = meeting[s].front();
        if (!boxes[outer].cavity && !ranges[outer].crosses_itself()) around[s] = outer;
    }
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> color(shells.count(), kNone);
    for (std::uint32_t s = 0; s < shells.count(); ++s) {
        if (shells.closed[s] == 0 || around[s] < shells.count()) continue;
        std::vector<char> taken(coloring.range.size() + 1, 0);
        for (const std::uint32_t other : meeting[s])
            if (color[other] != kNone) taken[color[other]] = 1;
        std::uint32_t c = 0;
        while (c < coloring.range.size() && (taken[c] != 0 || coloring.range[c] != ranges[s])) ++c;
        if (c == coloring.range.size()) coloring.range.push_back(ranges[s]);
        color[s] = c;
    }
    for (std::uint32_t s = 0; s < shells.count(); ++s) {
        if (shells.closed[s] == 0) continue;
        coloring.color[s] = around[s] < shells.count() ? color[around[s]] : color[s];
    }
    return coloring;
}

}  // namespace

SceneTopology::SceneTopology(const Device& device, const Scene& scene) : bodies_(find_bodies(scene)) {
    number_slots(scene);
    const auto usage = vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst;
    const std::size_t count = std::max<std::size_t>(scene.objects.size(), 1);
    traits = Buffer(device, "the objects' traits", count * 4, usage);
    shell_traits = Buffer(device, "the shells' traits", std::max<std::size_t>(shell_words_.size(), 1) * 4, usage);
    slots = Buffer(device, "the solids' slots", std::max<std::size_t>(slot_words_.size(), 4) * 4, usage);
    boxes = Buffer(device, "the objects' boxes", count * sizeof(ObjectBox), usage);
    eye = Buffer(device, "the solids around the eye", std::max<std::size_t>((slot_count + 31) / 32, 1) * 4, usage);
    if (!shell_words_.empty()) upload(device, shell_traits, std::as_bytes(std::span(shell_words_)));
    update(device, scene, 0);
}

/// Open surfaces come before all others, then bodies by rank.
void SceneTopology::number_slots(const Scene& scene) {
    std::map<const BodySurface*, Coloring> colorings;
    for (const Body& body : bodies_.all) {
        Coloring& coloring = colorings[body.surface.get()];
        if (coloring.color.empty()) coloring = color_shells(*body.surface);
    }
    std::vector<std::uint32_t> by_rank(bodies_.all.size());
    for (std::uint32_t b = 0; b < bodies_.all.size(); ++b) by_rank[bodies_.all[b].rank] = b;
    std::map<std::tuple<float, float, float, float, float>, std::uint32_t> media;
    std::vector<SlotRecord> records;
    body_slots_.resize(bodies_.all.size());
    const auto add = [&](const Body& body, std::uint32_t first, std::uint32_t count, std::uint32_t flags) {
        const Material& m = scene.materials[body.material];
        const glm::vec3 sigma = m.sigma_a();
        const auto next = std::uint32_t(media.size());
        const std::uint32_t medium =
            media.try_emplace({m.ior, m.dispersion, sigma.r, sigma.g, sigma.b}, next).first->second;
        records.push_back({body.material, first, count, medium | flags});
    };
    for (const std::uint32_t b : by_rank) {
        if (!colorings[bodies_.all[b].surface.get()].any_open) continue;
        body_slots_[b].open = std::uint32_t(records.size());
        add(bodies_.all[b], body_slots_[b].open, 1, 0);
    }
    for (const std::uint32_t b : by_rank) {
        const Coloring& coloring = colorings[bodies_.all[b].surface.get()];
        const auto first = std::uint32_t(records.size()), count = coloring.slot_count();
        body_slots_[b].closed = first;
        for (const WindingRange& range : coloring.range) {
            crossing = crossing || range.crosses_itself();
            for (int w = range.least; w < range.most; ++w)
                add(bodies_.all[b], first, count, (w < 0 ? kCavitySlot : 0u) | (w + 1 < range.most ? kSameShell : 0u));
        }
        with_inner_walls += count > 1 ? 1 : 0;
        many_slots = many_slots || count + (coloring.any_open ? 1 : 0) > 1;
    }
    slot_count = std::uint32_t(records.size());
    for (const SlotRecord& r : records) slot_words_.insert(slot_words_.end(), {r.material, r.first, r.count, r.medium});

    // What an object's traits would be if all of it were of one shell.
    for (std::uint32_t b = 0; b < bodies_.all.size(); ++b) {
        const Shells& shells = bodies_.all[b].surface->shells;
        const Coloring& coloring = colorings[bodies_.all[b].surface.get()];
        for (std::uint32_t s = 0; s < shells.count(); ++s) {
            std::uint32_t& word = body_slots_[b].words.emplace_back(body_slots_[b].open << kSlotShift);
            if (shells.closed[s] == 0) continue;
            const std::uint32_t c = coloring.color[s];
            word = kClosed | (body_slots_[b].closed + coloring.first_slot(c)) << kSlotShift;
            if (coloring.range[c] == kInward) word |= kCavity;
            if (coloring.range[c].crosses_itself()) word |= kCrossesItself;
        }
    }
    if (!many_slots) return;
    std::vector<std::size_t> first_triangle;
    std::size_t triangles = 0;
    for (const Mesh& mesh : scene.meshes) {
        first_triangle.push_back(triangles);
        triangles += mesh.triangles.size();
    }
    shell_words_.assign(triangles, 0);
    for (std::uint32_t b = 0; b < bodies_.all.size(); ++b) {
        const Body& body = bodies_.all[b];
        for (std::size_t k = 0; k < body.objects.size(); ++k) {
            const auto mesh = std::size_t(scene.objects[body.objects[k]].mesh);
            for (std::size_t t = 0; t < scene.meshes[mesh].triangles.size(); ++t) {
                const std::uint32_t word =
                    body_slots_[b].words[body.surface->shells.of_triangle[body.surface->first_triangle[k] + t]];
                // Wraps around where the open slot comes first; adding the object's word undoes it.
                shell_words_[first_triangle[mesh] + t] = word - (body_slots_[b].closed << kSlotShift);
            }
        }
    }
}

void SceneTopology::update(const Device& device, const Scene& scene, std::uint64_t moves_now) {
    std::vector<ObjectBox> uploaded;
    boxes_.clear();
    for (const Object& object : scene.objects) {
        const Mesh& mesh = scene.meshes[std::size_t(object.mesh)];
        Box box;
        for (const glm::vec3& p : mesh.positions) {
            const glm::vec3 world(object.world_from_object * glm::vec4(p, 1.0f));
            box.low = glm::min(box.low, world);
            box.high = glm::max(box.high, world);
        }
        const glm::vec3 middle = 0.5f * (box.low + box.high), size = box.high - box.low;
        float radius = 0.0f;
        for (const glm::vec3& p : mesh.positions)
            radius = std::max(radius, glm::distance(middle, glm::vec3(object.world_from_object * glm::vec4(p, 1.0f))));
        boxes_.push_back(box);
        uploaded.push_back({box.low, radius, box.high, kContact * std::max({size.x, size.y, size.z, 0.0f})});
    }
    body_boxes_.clear();
    for (const Body& body : bodies_.all) {  // one extent for all of a body
        Box& all = body_boxes_.emplace_back();
        for (const std::uint32_t i : body.objects) {
            all.low = glm::min(all.low, boxes_[i].low);
            all.high = glm::max(all.high, boxes_[i].high);
        }
        const glm::vec3 size = all.high - all.low;
        for (const std::uint32_t i : body.objects)
            uploaded[i].contact = kContact * std::max({size.x, size.y, size.z, 0.0f});
    }

    largest_contact = 0.0f;
    for (const ObjectBox& box : uploaded) largest_contact = std::max(largest_contact, box.contact);
    all_alone = true;
    trait_words_.clear();
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        const Material& material = scene.materials[std::size_t(scene.objects[i].material)];
        const std::uint32_t body = bodies_.of_object[i];
        bool touches = false;
        for (std::uint32_t k = 0; k < boxes_.size() && !touches; ++k) {
            if (k == i || (body != kNoBody && bodies_.of_object[k] == body)) continue;
            // A few roundings of a coordinate apart still counts as touching.
            const float rounding = 1e-6f * std::max({glm::length(boxes_[i].low), glm::length(boxes_[i].high),
                                                     glm::length(boxes_[k].high)});
            touches = meet(boxes_[i], boxes_[k], std::max({rounding, uploaded[i].contact, uploaded[k].contact}));
        }
        std::uint32_t word = material.refractive() ? 2u : material.transmissive() ? 1u : 0u;
        if (material.has_holes()) word |= kCutOut;
        if (material.single_sided()) word |= kSingleSided;
        if (body != kNoBody) {
            const BodySlots& own = body_slots_[body];
            word |= many_slots ? own.closed << kSlotShift : own.words.front();
            const std::vector<std::uint32_t>& words = own.words;
            touches = touches || std::any_of(words.begin(), words.end(), [&](auto w) { return w != words.front(); });
        }
        all_alone = all_alone && !touches;
        trait_words_.push_back(word | (touches ? kTouches : 0u));
    }
    upload_later(device, traits, std::as_bytes(std::span(trait_words_)));
    if (!slot_words_.empty()) upload_later(device, slots, std::as_bytes(std::span(slot_words_)));
    if (!uploaded.empty()) upload_later(device, boxes, std::as_bytes(std::span(uploaded)));
    moves = moves_now;
}

void SceneTopology::mark_replaced(const Device& device, const std::vector<int>& objects) {
    std::vector<std::uint32_t> words = trait_words_, records = slot_words_;
    for (const int object : objects) {
        const std::uint32_t body = bodies_.of_object[std::size_t(object)];
        if (body == kNoBody) continue;
        words[std::size_t(object)] |= kReplaced;
        for (const std::uint32_t word : body_slots_[body].words) {
            for (std::uint32_t slot = word >> kSlotShift;; ++slot) {
                records[4 * slot] |= kReplacedSolid;
                records[4 * slot + 3] |= kReplacedMedium | slot;  // a medium like no other
                if ((slot_words_[4 * slot + 3] & kSameShell) == 0) break;
            }
        }
    }
    upload_later(device, traits, std::as_bytes(std::span(words)));
    if (!records.empty()) upload_later(device, slots, std::as_bytes(std::span(records)));
}

void SceneTopology::look_from(const Device& device, const Scene& scene, const Camera& camera) {
    const glm::dvec3 at(camera.world_from_view[3]);
    std::vector<std::uint32_t> bits(std::max<std::size_t>((slot_count + 31) / 32, 1), 0);
    eye_in_solid = eye_differs = false;
    eye_depth = camera.near_plane;
    const bool one_origin = !camera.orthographic && camera.near_plane == 0.0f;
    std::vector<double> windings(slot_count, 0.0);
    for (std::uint32_t b = 0; b < bodies_.all.size(); ++b) {
        const Body& body = bodies_.all[b];
        for (std::size_t k = 0; k < body.objects.size(); ++k) {
            const Box& box = boxes_[body.objects[k]];
            if (!one_origin) {
                // In view space: does the box reach the plane on which rays start?
                const glm::dmat4 view_from_world = glm::inverse(glm::dmat4(camera.world_from_view));
                double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
                for (int corner = 0; corner < 8; ++corner) {
                    const glm::dvec3 p((corner & 1) != 0 ? box.high.x : box.low.x,
                                       (corner & 2) != 0 ? box.high.y : box.low.y,
                                       (corner & 4) != 0 ? box.high.z : box.low.z);
                    const double depth = -(view_from_world * glm::dvec4(p, 1.0)).z - double(camera.near_plane);
                    nearest = std::min(nearest, depth);
                    farthest = std::max(farthest, depth);
                }
                eye_differs = eye_differs || (nearest <= 0.0 && farthest >= 0.0);
                continue;
            }
            // What is open in one object of a body closes in another.
            if (glm::any(glm::lessThan(at, glm::dvec3(body_boxes_[b].low))) ||
                glm::any(glm::greaterThan(at, glm::dvec3(body_boxes_[b].high))))
                continue;
            const Object& object = scene.objects[body.objects[k]];
            const Mesh& mesh = scene.meshes[std::size_t(object.mesh)];
            const glm::dmat4 world_from_object(object.world_from_object);
            const double sense = glm::determinant(glm::dmat3(world_from_object)) < 0.0 ? -1.0 : 1.0;
            std::vector<glm::dvec3> from_eye;
            for (const glm::vec3& p : mesh.positions)  // as rounded as the surfaces that rays meet
                from_eye.push_back(glm::dvec3(glm::vec3(world_from_object * glm::dvec4(glm::dvec3(p), 1.0))) - at);
            for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
                const std::uint32_t word =
                    body_slots_[b].words[body.surface->shells.of_triangle[body.surface->first_triangle[k] + t]];
                if ((word & kClosed) == 0) continue;
                const glm::uvec3 c = mesh.triangles[t];
                windings[word >> kSlotShift] += sense * winding_number(from_eye[c.x], from_eye[c.y], from_eye[c.z]);
            }
        }
    }
    const auto medium = [&](std::uint32_t slot) { return slot_words_[4 * slot + 3]; };
    for (std::uint32_t slot = 0; slot < slot_count; ++slot) {
        const std::uint32_t first = slot;  // of the shell's: its winding number is the same for all
        while ((medium(slot) & kSameShell) != 0) ++slot;
        std::uint32_t above = 0;  // slots that the winding number has passed
        for (std::uint32_t s = first; s <= slot; ++s) above += (medium(s) & kCavitySlot) != 0 ? 1 : 0;
        const std::int64_t passed = std::int64_t(above) + std::llround(windings[first]);
        for (std::uint32_t s = first; s <= slot; ++s) {
            const bool cavity = (medium(s) & kCavitySlot) != 0, up = std::int64_t(s - first) < passed;
            if (up == cavity) continue;
            bits[s / 32] |= 1u << s % 32;
            eye_in_solid = true;
        }
    }
    if (bits != eye_bits_) upload_later(device, eye, std::as_bytes(std::span(bits)));
    eye_bits_ = std::move(bits);
}

}  // namespace pellucid
