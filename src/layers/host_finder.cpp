// Wald, Woop, Benthin, Johnson, Ernst: Embree, a kernel framework for efficient CPU ray tracing, ACM Transactions on
// Graphics 33(4), 2014.
#include "layers/host_finder.h"

#include "layers/map_building.h"

#include <pellucid/error.h>

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

namespace pellucid {
namespace {

// Twins in object_traits.glsl.
constexpr std::uint32_t kKindMask = 3, kRefractiveKind = 2, kClosed = 4, kTouchesOthers = 8, kCavity = 64,
                        kSingleSided = 128, kCrossesItself = 256, kSlotShift = 9, kCavitySlot = 0x80000000,
                        kSameShell = 0x20000000;
// Distances ahead and behind, along a flat ray, between surfaces that touch. Multiples of the contact distance; twins
// in follow_paths.glsl.
constexpr float kGrazing = 512.0f, kBehind = 32.0f, kSpacings = 4.8e-7f;

constexpr std::size_t kGrain = 256;  // paths per task

struct DeviceDeleter {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};

struct Placed {
    std::vector<glm::vec3> positions;  ///< world; one extra at the end, as Embree reads 16 bytes at the last vertex
    std::uint32_t first_triangle = 0;  ///< over all objects
    float sense = 1.0f;                ///< -1: mirrored, so normals from the winding point inwards
};

struct Ray {
    glm::vec3 origin, direction;
};

struct Hit {
    float t;
    Candidate surface;
    bool leaving;
};

/// Context of an Embree ray. Embree passes the address of the first member to accept_hit().
struct Search {
    RTCIntersectContext embree{};
    const std::vector<Placed>* objects = nullptr;
    const std::vector<std::uint32_t>* traits = nullptr;  ///< per triangle over all objects
    const std::uint32_t* media = nullptr;                ///< media of the searching path
    std::uint32_t standing = 0;                          ///< triangle on which the searching path starts
    std::vector<Hit>* all = nullptr;  ///< if set, receives every hit, and the search finds no nearest hit
};

bool is_closed_shell(std::uint32_t traits) { return (traits & (kKindMask | kClosed)) == (kRefractiveKind | kClosed); }

/// Twin of can_meet() in path_walk.glsl for a path that has crossed no surface in this search.
bool can_meet(const Search& path, std::uint32_t traits, bool leaving, std::uint32_t triangle) {
    if (!is_closed_shell(traits)) return triangle != path.standing && !(leaving && (traits & kSingleSided) != 0);
    if ((traits & kCrossesItself) != 0) return triangle != path.standing;
    const std::uint32_t slot = traits >> kSlotShift;
    return ((path.media[slot / 32] >> slot % 32 & 1) != 0) == (leaving != ((traits & kCavity) != 0));
}

void accept_hit(const RTCFilterFunctionNArguments* args) {
    const auto& search = *reinterpret_cast<const Search*>(args->context);
    const auto& ray = *reinterpret_cast<const RTCRay*>(args->ray);
    const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
    const Placed& object = (*search.objects)[hit.geomID];
    const std::uint32_t triangle = object.first_triangle + hit.primID, traits = (*search.traits)[triangle];
    const float along = hit.Ng_x * ray.dir_x + hit.Ng_y * ray.dir_y + hit.Ng_z * ray.dir_z;
    const bool leaving = object.sense * along > 0.0f;
    if (search.all != nullptr) search.all->push_back({ray.tfar, {triangle, traits}, leaving});
    if (search.all != nullptr || !can_meet(search, traits, leaving, triangle)) args->valid[0] = 0;
}

/// Moves a path to the other side of a shell; twin of step_across() in cross_surface.glsl.
void step_across(std::span<const std::uint32_t> slot_words, std::uint32_t* media, std::uint32_t traits, bool leaving) {
    const auto inside = [&](std::uint32_t slot) { return (media[slot / 32] >> slot % 32 & 1) != 0; };
    const auto cavity = [&](std::uint32_t slot) { return (slot_words[4 * slot + 3] & kCavitySlot) != 0; };
    std::uint32_t slot = traits >> kSlotShift;
    if ((traits & kCrossesItself) == 0) {
        if (inside(slot) != (leaving == ((traits & kCavity) != 0))) media[slot / 32] ^= 1u << slot % 32;
        return;
    }
    constexpr std::uint32_t kNone = 0xffffffffu;
    std::uint32_t changed = kNone;
    for (bool more = true; more; ++slot) {
        const bool passed = inside(slot) != cavity(slot);
        if (leaving ? passed : !passed && changed == kNone) changed = slot;
        more = (slot_words[4 * slot + 3] & kSameShell) != 0;
    }
    if (changed != kNone && inside(changed) != (leaving == cavity(changed))) media[changed / 32] ^= 1u << changed % 32;
}

std::size_t number_of(const PathsOnHost& paths, std::uint32_t pixel) {
    return std::size_t(pixel >> 16) * paths.width + (pixel & 0xffffu);
}

bool in_the_open(const PathsOnHost& paths, std::size_t path) {
    const std::uint32_t* media = paths.media + path * (paths.words + 1);
    return std::all_of(media, media + paths.words, [](std::uint32_t word) { return word == 0; });
}

void check_embree(RTCDevice device) {
    const RTCError code = rtcGetDeviceError(device);
    if (code == RTC_ERROR_NONE) return;
    throw Error(fmt::format("Embree cannot build the hierarchy of the scene's triangles: {}",
                            code == RTC_ERROR_OUT_OF_MEMORY ? "out of memory" : fmt::format("error {}", int(code))));
}

}  // namespace

struct HostFinder::Hierarchy {
    explicit Hierarchy(std::uint32_t threads) : arena(threads > 0 ? int(threads) : tbb::task_arena::automatic) {}

    mutable tbb::task_arena arena;
    std::unique_ptr<RTCDeviceTy, DeviceDeleter> device;
    std::unique_ptr<RTCSceneTy, SceneDeleter> scene;
    std::vector<Placed> objects;
    std::vector<std::uint32_t> traits;
    std::span<const std::uint32_t> slot_words;  ///< of the SceneTopology
    Buffer triangles, normals;
    float largest_contact = 0.0f;
    std::uint64_t moves = 0;
    bool deforming = false;

    void place(std::uint32_t object, const Scene& from, const GpuScene& gpu_scene);
    void build(const Scene& from);
    void refit(std::uint32_t object);
    void name_traits(const GpuScene& gpu_scene);

    Search search() const {
        Search search{.objects = &objects, .traits = &traits};
        rtcInitIntersectContext(&search.embree);
        search.embree.filter = accept_hit;
        return search;
    }
    /// Divides `count` paths into ranges and calls work(range) for each, on all threads.
    template <class Work>
    void share_out(std::size_t count, const Work& work) const {
        arena.execute([&] { tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain), work); });
    }
    RTCRayHit shoot(Search& search, const Ray& ray, float from, float to) const;
    void add_nearby(Search& search, const Ray& ray, const PathsOnHost& paths, Candidate surface, float t,
                    std::vector<Candidate>& found) const;
    void find_candidates(Search& search, std::size_t path, const PathsOnHost& paths,
                         std::vector<Candidate>& found) const;
};

/// Updates the object's world positions, its triangles for the device (surface_map.glsl) and their normals.
void HostFinder::Hierarchy::place(std::uint32_t object, const Scene& from, const GpuScene& gpu_scene) {
    const Object& own = from.objects[object];
    const Mesh& mesh = from.meshes[std::size_t(own.mesh)];
    Placed& placed = objects[object];
    placed.first_triangle = gpu_scene.first_triangles[object];
    placed.sense = glm::determinant(glm::mat3(own.world_from_object)) < 0.0f ? -1.0f : 1.0f;
    placed.positions.resize(mesh.positions.size() + 1);
    const glm::mat3 normals_from_object = glm::transpose(glm::inverse(glm::mat3(own.world_from_object)));
    auto* corners = reinterpret_cast<glm::vec4*>(triangles.mapped());
    auto* corner_normals = reinterpret_cast<glm::vec4*>(normals.mapped());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.positions.size(), 4096), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i)
            placed.positions[i] = glm::vec3(own.world_from_object * glm::vec4(mesh.positions[i], 1.0f));
    });
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.triangles.size(), 4096), [&](const auto& range) {
        for (std::size_t t = range.begin(); t != range.end(); ++t) {
            glm::uvec3 c = mesh.triangles[t];
            if (placed.sense < 0.0f) std::swap(c.y, c.z);
            const std::size_t at = 3 * (placed.first_triangle + t);
            const glm::vec3 a = placed.positions[c.x];
            corners[at] = glm::vec4(a, 0.0f);
            corners[at + 1] = glm::vec4(placed.positions[c.y] - a, 0.0f);
            corners[at + 2] = glm::vec4(placed.positions[c.z] - a, 0.0f);
            for (int k = 0; k < 3; ++k)
                corner_normals[at + std::size_t(k)] = glm::vec4(normals_from_object * mesh.normals[c[k]], 0.0f);
        }
    });
}

void HostFinder::Hierarchy::build(const Scene& from) {
    scene.reset(rtcNewScene(device.get()));
    const unsigned flags = unsigned(RTC_SCENE_FLAG_ROBUST) | unsigned(RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION) |
                           (deforming ? unsigned(RTC_SCENE_FLAG_DYNAMIC) : 0u);
    rtcSetSceneFlags(scene.get(), RTCSceneFlags(flags));
    // Embree keeps a hierarchy per object, which it can refit, only in a scene of low quality.
    rtcSetSceneBuildQuality(scene.get(), deforming ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const std::vector<glm::uvec3>& corners = from.meshes[std::size_t(from.objects[i].mesh)].triangles;
        const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, objects[i].positions.data(),
                                   0, sizeof(glm::vec3), objects[i].positions.size() - 1);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, corners.data(), 0,
                                   sizeof(glm::uvec3), corners.size());
        rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene.get(), geometry, unsigned(i));
        rtcReleaseGeometry(geometry);
    }
}

void HostFinder::Hierarchy::name_traits(const GpuScene& gpu_scene) {
    const std::vector<std::uint32_t>& of_objects = gpu_scene.topology->trait_words();
    const std::vector<std::uint32_t>& of_shells = gpu_scene.topology->shell_words();
    traits.resize(gpu_scene.triangle_count);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const GpuMesh& mesh = gpu_scene.meshes[gpu_scene.mesh_of_object[i]];
        for (std::uint32_t t = 0; t < mesh.triangle_count; ++t)
            traits[objects[i].first_triangle + t] =
                of_objects[i] + (of_shells.empty() ? 0u : of_shells[mesh.first_corner / 3 + t]);
    }
    slot_words = gpu_scene.topology->slot_words();
    largest_contact = gpu_scene.topology->largest_contact;
}

HostFinder::HostFinder(std::uint32_t threads) : hierarchy_(std::make_unique<Hierarchy>(threads)) {}
HostFinder::~HostFinder() = default;

const Buffer& HostFinder::triangles() const { return hierarchy_->triangles; }
const Buffer& HostFinder::normals() const { return hierarchy_->normals; }

void HostFinder::bring_up_to_date(const Device& device, const Scene& scene, const GpuScene& gpu_scene, bool deforming) {
    Hierarchy& own = *hierarchy_;
    const bool first = !own.scene;  // also if an earlier call failed half way
    // An object that has moved once is likely to move again.
    deforming = deforming || own.deforming || gpu_scene.moves > 0;
    if (!first && own.moves == gpu_scene.moves && own.deforming == deforming) return;
    if (first) {
        own.device.reset(rtcNewDevice(nullptr));
        if (!own.device) throw Error(fmt::format("Embree cannot start: error {}", int(rtcGetDeviceError(nullptr))));
        own.objects.resize(scene.objects.size());
        const vk::DeviceSize bytes = std::max<std::uint64_t>(gpu_scene.triangle_count, 1) * kMapTriangleSize;
        const auto usage = vk::BufferUsageFlagBits::eStorageBuffer;
        own.triangles = Buffer(device, "triangles for the host's finder", bytes, usage, true, kMapFormat);
        own.normals = Buffer(device, "normals for the host's finder", bytes, usage, true, kMapFormat);
    }
    const bool rebuild = first || own.deforming != deforming;
    own.deforming = deforming;
    for (std::uint32_t i = 0; i < own.objects.size(); ++i) {
        const std::uint64_t as_a_whole = gpu_scene.object_moves.empty() ? 0 : gpu_scene.object_moves[i];
        const std::uint64_t moved = std::max(gpu_scene.meshes[gpu_scene.mesh_of_object[i]].moves, as_a_whole);
        if (!first && moved <= own.moves) continue;
        own.place(i, scene, gpu_scene);
        if (!rebuild) own.refit(i);
    }
    if (rebuild) own.build(scene);
    rtcCommitScene(own.scene.get());
    check_embree(own.device.get());
    own.name_traits(gpu_scene);
    own.moves = gpu_scene.moves;
}

void HostFinder::Hierarchy::refit(std::uint32_t object) {
    const RTCGeometry geometry = rtcGetGeometry(scene.get(), object);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
    rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(geometry);
}

void HostFinder::refit() {
    for (std::uint32_t i = 0; i < hierarchy_->objects.size(); ++i) hierarchy_->refit(i);
    rtcCommitScene(hierarchy_->scene.get());
}

/// Traces a ray between two distances, m. The ray starts at `from`, because Embree ignores negative distances.
RTCRayHit HostFinder::Hierarchy::shoot(Search& search, const Ray& ray, float from, float to) const {
    const glm::vec3 start = ray.origin + from * ray.direction;
    RTCRayHit hit{};
    hit.ray.org_x = start.x, hit.ray.org_y = start.y, hit.ray.org_z = start.z;
    hit.ray.dir_x = ray.direction.x, hit.ray.dir_y = ray.direction.y, hit.ray.dir_z = ray.direction.z;
    hit.ray.tfar = to - from;
    hit.ray.mask = ~0u;
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene.get(), &search.embree, &hit);
    hit.ray.tfar += from;
    return hit;
}

/// Appends the surface at distance `t` and all surfaces that may touch it there.
void HostFinder::Hierarchy::add_nearby(Search& search, const Ray& ray, const PathsOnHost& paths, Candidate surface,
                                       float t, std::vector<Candidate>& found) const {
    found.push_back(surface);
    if (!paths.touching || (surface.traits & kTouchesOthers) == 0) return;
    const glm::vec3 at = ray.origin + t * ray.direction;
    const float farthest = std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)});
    const float apart = std::max(largest_contact, kSpacings * farthest);
    std::vector<Hit> nearby;
    search.all = &nearby;
    shoot(search, ray, t - kBehind * apart, t + kGrazing * apart);
    search.all = nullptr;
    for (const Hit& hit : nearby)
        if (hit.surface.triangle != surface.triangle) found.push_back(hit.surface);
}

/// Appends the candidates of a path.
void HostFinder::Hierarchy::find_candidates(Search& search, std::size_t path, const PathsOnHost& paths,
                                            std::vector<Candidate>& found) const {
    search.media = paths.media + path * (paths.words + 1);
    search.standing = std::bit_cast<std::uint32_t>(paths.places[path].w);
    const Ray ray{glm::vec3(paths.places[path]), glm::vec3(paths.ways[path])};
    // A surface within the coincidence distance may lie behind the path. Then the next surface is a candidate, too.
    for (const float from : {-paths.coincidence, paths.coincidence}) {
        const RTCRayHit hit = shoot(search, ray, from, std::numeric_limits<float>::infinity());
        if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
        const std::uint32_t triangle = objects[hit.hit.geomID].first_triangle + hit.hit.primID;
        add_nearby(search, ray, paths, {triangle, traits[triangle]}, hit.ray.tfar, found);
        if (hit.ray.tfar > paths.coincidence) return;
    }
}

void HostFinder::find(const PathsOnHost& paths, const CandidatesOnHost& candidates,
                      const PixelListOnHost& ended) const {
    const std::span<const std::uint32_t> pixels = paths.list.pixels();
    std::vector<std::uint32_t> looking(pixels.size());
    std::atomic<std::uint32_t> next{1}, looking_count{0}, ended_count{std::uint32_t(ended.pixels().size())};
    const auto room = std::uint32_t(candidates.all.size());
    hierarchy_->share_out(pixels.size(), [&](const auto& range) {
        Search search = hierarchy_->search();
        std::vector<Candidate> found;
        std::vector<std::uint32_t> ends, go_on, end;
        found.reserve(2 * range.size());
        ends.reserve(range.size());
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            hierarchy_->find_candidates(search, number_of(paths, pixels[i]), paths, found);
            ends.push_back(std::uint32_t(found.size()));
        }
        const std::uint32_t first = next.fetch_add(std::uint32_t(found.size()));
        const bool fits = first + found.size() <= room;
        if (fits) std::copy(found.begin(), found.end(), candidates.all.begin() + first);
        std::uint32_t begin = 0;
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const std::size_t path = number_of(paths, pixels[i]);
            const std::uint32_t past = ends[i - range.begin()];
            candidates.lists[path] = {first + begin, fits ? past - begin : 0};
            (past > begin || !in_the_open(paths, path) ? go_on : end).push_back(pixels[i]);
            begin = past;
        }
        std::copy(go_on.begin(), go_on.end(), looking.begin() + looking_count.fetch_add(std::uint32_t(go_on.size())));
        std::copy(end.begin(), end.end(), ended.data() + ended_count.fetch_add(std::uint32_t(end.size())));
    });
    std::copy_n(looking.begin(), looking_count.load(), paths.list.data());
    paths.list.set_size(looking_count);
    ended.set_size(ended_count);
    std::uint32_t& most = candidates.all.front().triangle;
    most = std::max(most, next.load());
}

/// Twin of find_media() in path_walk.glsl.
void HostFinder::find_media(const PathsOnHost& paths) const {
    const Hierarchy& own = *hierarchy_;
    const std::span<const std::uint32_t> pixels = paths.list.pixels();
    own.share_out(pixels.size(), [&](const auto& range) {
        Search search = own.search();
        std::vector<Hit> hits;
        std::vector<std::uint32_t> decided(paths.words);
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const std::size_t path = number_of(paths, pixels[i]);
            const Ray ray{glm::vec3(paths.places[path]), glm::vec3(paths.ways[path])};
            hits.clear();
            search.all = &hits;
            own.shoot(search, ray, 0.0f, std::numeric_limits<float>::infinity());
            std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.t < b.t; });
            std::uint32_t* media = paths.media + path * (paths.words + 1);
            std::fill_n(media, paths.words, 0);
            std::fill(decided.begin(), decided.end(), 0);
            std::map<std::uint32_t, int> windings;  // windings of shells that cross themselves, by traits
            for (const Hit& hit : hits) {
                const std::uint32_t traits = hit.surface.traits, slot = traits >> kSlotShift, bit = 1u << slot % 32;
                if (!is_closed_shell(traits)) continue;
                if ((traits & kCrossesItself) != 0) {
                    windings[traits] += hit.leaving ? 1 : -1;
                } else if ((decided[slot / 32] & bit) == 0) {
                    decided[slot / 32] |= bit;
                    if (hit.leaving != ((traits & kCavity) != 0)) media[slot / 32] |= bit;
                }
            }
            for (auto [traits, winding] : windings) {
                for (; winding > 0; --winding) step_across(own.slot_words, media, traits, false);
                for (; winding < 0; ++winding) step_across(own.slot_words, media, traits, true);
            }
        }
    });
}

}  // namespace pellucid
