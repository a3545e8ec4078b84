#include "techniques/visibility_layers/paths.h"

#include "layers/map_building.h"
#include "layers/pixel_list.h"
#include "techniques/shaders.h"

#include <algorithm>
#include <array>

namespace pellucid {
namespace {

/// That there is time for beyond those of the longest path, for each branch: most branches leave soon.
constexpr std::uint32_t kSurfacesPerBranch = 4;
/// Surfaces budgeted per shadow ray, likewise: most meet none, or end at the first.
constexpr std::uint32_t kSurfacesPerShadowRay = 2;
/// Twins in look_at_lights.glsl.
constexpr std::uint32_t kMostShadowRays = 4, kMostSkyRays = 4;
/// That there is time for on the longest path where solids overlap: most surfaces there are inside of something.
constexpr std::uint32_t kSurfacesPerEvent = 4;
/// That there is time for on the longest path, besides its surfaces: a path leaves a volume at each surface in it.
constexpr std::uint32_t kVolumesPerPath = 16;

/// Surfaces that a path meets in one dispatch. Each dispatch waits for its longest path: the fewer, the less a GPU idles;
/// on a CPU device eight paths in step wait for the longest among them, so those that have ended had better be left out.
constexpr std::uint32_t kSurfacesPerPass = 16;
constexpr std::uint32_t kSurfacesPerPassOnCpu = 4;

/// More bounces than any path has.
constexpr std::uint32_t kNeverCached = 8;

constexpr std::array<const char*, 2> kListNames = {"paths 0", "paths 1"};

/// Words of PathMedia per path.
std::uint32_t words_of(const SceneTopology& topology) { return std::max((topology.slot_count + 31) / 32, 1u); }

/// What becomes of paths that the map loses: they end there, or are set aside for another.
enum class Lost { kEnd, kSetAside };

class Paths {
public:
    Paths(Recorder& recorder, const Frame& frame, LayerSource& source, const SurfaceFinder& finder,
          const PathTask& task)
        : recorder_(recorder), frame_(frame), source_(source), task_(task), map_(finder.map),
          lost_(finder.loses_paths ? Lost::kSetAside : Lost::kEnd), finishing_(finder.finishing), finder_(finder.host),
          hierarchy_(finder.hierarchy), topology_(*frame.scene.topology), push_(task.push),
          words_(words_of(topology_)) {
        if (task.volumes != nullptr) task.volumes->set(push_);
        push_.largest_contact = topology_.largest_contact;
        push_.coincidence = 1e-6f * (glm::length(frame.scene.bounds.center) + frame.scene.bounds.radius);
        surfaces_per_pass_ = finder_ != nullptr ? 1 : task.surfaces_per_pass;
        if (surfaces_per_pass_ == 0)
            surfaces_per_pass_ = frame.workspace.device().is_cpu() ? kSurfacesPerPassOnCpu : kSurfacesPerPass;
    }

    void follow() {
        begin_branches();
        if (finder_ != nullptr) begin_candidates();
        group_ = path_bindings();
        for (std::size_t i = 0; i < lists_.size(); ++i) lists_[i] = &start_pixel_list(recorder_, frame_, kListNames[i]);
        next_ = lists_[0];
        begin();
        begin_at_end();
        if (task_.ends_together) ended_ = &start_pixel_list(recorder_, frame_, "ended paths");
        walk();
        if (lost_ == Lost::kSetAside) finish_lost();
        if (task_.ends_together) end(*ended_, false);
        if (branches_apart()) branches().end(recorder_);
        if (finder_ != nullptr) candidates().end(recorder_);
    }

private:
    /// Takes the paths that the map has lost to their ends, if there is another map; says how many they are.
    void finish_lost() {
        recorder_.read<std::uint32_t>(*aside_, kListLengthOffset,
                                      [&source = source_](std::uint32_t count) { source.note_lost_paths(count); });
        if (!finishing_) return;
        lost_ = Lost::kEnd;
        map_ = *finishing_;
        group_ = path_bindings();
        next_ = aside_;
        walk();
    }

    /// Takes the paths of `next_` from surface to surface until all have ended, or the map has lost them.
    void walk() {
        if (lost_ == Lost::kSetAside) aside_ = &start_pixel_list(recorder_, frame_, "lost paths");
        for (std::uint32_t pass = 0; pass < pass_count(); ++pass) {
            if (!task_.ends_together) ended_ = &start_pixel_list(recorder_, frame_, "ended paths");
            const Buffer& aside = lost_ == Lost::kSetAside ? *aside_ : start_entering();
            if (finder_ != nullptr) find_on_host(pass == 0);
            follow(pass, aside);
            if (task_.volumes != nullptr) task_.volumes->march(this->pass(), aside, *next_, *ended_);
            if (!task_.ends_together) end(*ended_, false);
        }
        if (finder_ != nullptr) recorder_.end_of_steps();
        end(*next_, true);
    }

    std::uint32_t pass_count() const {
        const auto in_passes = [&](std::uint32_t surfaces) {
            return (surfaces + surfaces_per_pass_ - 1) / surfaces_per_pass_;
        };
        const std::uint32_t surfaces = (push_.max_events + 1) * (topology_.all_alone ? 1 : kSurfacesPerEvent);
        // A pass takes a path through one volume at most.
        if (task_.volumes != nullptr)
            return std::max(in_passes(surfaces), push_.max_events + kVolumesPerPath) +
                   push_.most_branches * kSurfacesPerBranch;
        const std::uint32_t branches = std::max(push_.most_branches, push_.most_bounces);
        const std::uint32_t shadow_rays =
            (std::min(push_.direct_lights + (push_.emitter_count > 0 ? 1 : 0), kMostShadowRays) +
             (frame_.environment_shares != nullptr ? kMostSkyRays : 0)) *
            (1 + branches);
        const std::uint32_t glass_rays = task_.looks_from_glass(frame_.scene) ? push_.max_events + 2 * branches : 0;
        return in_passes(surfaces) + branches * in_passes(kSurfacesPerBranch + surfaces_per_pass_ - 1) +
               (shadow_rays + glass_rays) * in_passes(kSurfacesPerShadowRay + surfaces_per_pass_ - 1);
    }

    std::uint64_t pixels() const { return std::uint64_t(frame_.extent.width) * frame_.extent.height; }

    std::vector<Constant> constants() const {
        const GpuScene& scene = frame_.scene;
        return {{"kMediumWords", words_},
                {"kOneObject", scene.object_count == 1},
                {"kTree", task_.ways == Ways::kTree},
                {"kStochastic", task_.ways == Ways::kStochastic},
                {"kDispersive", scene.dispersive},
                {"kRough", scene.rough_glass},
                {"kEnvironmentKind", frame_.environment_kind},
                {"kOpaqueObjects", !scene.opaque.empty()},
                {"kFinishes", scene.finished},
                {"kBackground", frame_.background_depth != nullptr},
                {"kMapPerMesh", map_.objects != nullptr},
                {"kFinished", lost_ == Lost::kSetAside},
                {"kTouching", !topology_.all_alone},
                {"kSurfacesPerPass", surfaces_per_pass_},
                {"kVolumes", task_.volumes != nullptr},
                {"kManySlots", topology_.many_slots},
                {"kTexturedGlass", scene.textured_glass},
                {"kCrossing", topology_.crossing},
                {"kFoundOnHost", finder_ != nullptr},
                {"kLightsSurfaces", task_.lights_surfaces},
                {"kFullLight", task_.full_light},
                {"kVisibleLights", frame_.light.visible_lights()},
                {"kFromLight", task_.from_light},
                {"kPhotons", frame_.photons != nullptr},
                {"kPhotonsOfEmitters", frame_.light.photons_of_emitters},
                {"kPhotonsOfEnvironment", frame_.light.photons_of_environment},
                {"kEnvironmentRays", frame_.environment_shares != nullptr && task_.full_light},
                {"kGathers", task_.gathers},
                {"kConverges", frame_.light.bounces > 0 && frame_.bounces_before_cache > 0 && !task_.gathers},
                {"kCachedFrom", frame_.irradiance != nullptr ? frame_.bounces_before_cache : kNeverCached}};
    }
    const Program& program(ShaderCode shader) { return frame_.workspace.compute(shader, constants()); }

    PathPass pass() const { return {recorder_, frame_, constants(), all_of(group_), push_}; }

    /// By the names of visibility_bindings.glsl, path_state.glsl, path_walk.glsl and path_light.glsl.
    std::vector<Binding> path_bindings() const {
        std::vector<Binding> bindings = {updates("PathPlaces", places_),
                                         updates("PathWays", ways_buffer_),
                                         updates("PathWeights", weights_),
                                         updates("PathMedia", media_),
                                         updates("Waiting", waiting_),
                                         updates("Branches", *branches_),
                                         reads("Slots", topology_.slots),
                                         reads("Traits", topology_.traits),
                                         reads("ShellTraits", topology_.shell_traits),
                                         reads("Boxes", topology_.boxes),
                                         reads("EyeMedia", topology_.eye),
                                         reads("Maps", *map_.maps),
                                         reads("map_triangles", *map_.triangles),
                                         reads("map_normals", *map_.normals),
                                         reads("texels", *map_.texels),
                                         reads("ranges", *map_.ranges),
                                         reads("records", *map_.records),
                                         reads("pyramid", *map_.pyramid),
                                         reads("MappedObjects", map_.objects != nullptr ? *map_.objects : *map_.maps),
                                         reads("candidate_lists", *map_.texels),
                                         reads("candidates", *map_.records),
                                         all_of(task_.bindings)};
        if (hierarchy_ != nullptr) bindings.push_back(reads("hierarchy", *hierarchy_));
        return bindings;
    }
    ShaderCode follow_shader() const {
        if (task_.volumes != nullptr) return task_.volumes->follow_shader();
        return hierarchy_ != nullptr ? shaders::follow_traced_paths_comp : shaders::follow_paths_comp;
    }

    CountedBuffer& branches() {
        const std::uint32_t vectors = 4 + (words_ + 1) / 4;  // kBranchVectors of path_state.glsl
        return source_.counted("branches", vectors * 16);
    }
    bool branches_apart() const { return task_.ways == Ways::kTree || task_.lights_surfaces; }
    void begin_branches() {
        branches_ = &frame_.workspace.buffer("no branches", 16);  // something has to be bound
        if (!branches_apart()) return;
        branches_ = &branches().begin(recorder_, frame_.workspace, pixels() / 4 + 1024);
        push_.branch_capacity = branches().capacity();
    }

    const Buffer& start_entering() const {
        // Something has to be bound where no path enters anything.
        return task_.volumes != nullptr ? start_pixel_list(recorder_, frame_, "paths that enter volumes") : *ended_;
    }

    CountedBuffer& candidates() { return source_.counted("candidates", sizeof(Candidate), kMapPairFormat, true); }
    void begin_candidates() {
        map_.records = &candidates().begin(recorder_, frame_.workspace, pixels() + pixels() / 4 + 1024);
        map_.texels =
            &frame_.workspace.buffer("candidate lists", pixels() * sizeof(CandidateList), true, kMapPairFormat);
    }

    void begin() {
        if (task_.begin.words.empty()) return;
        const Program& program = this->program(task_.begin);
        const std::vector<Binding> bindings = {frame_.bindings(), all_of(group_), all_of(volume_group_),
                                               updates("NextList", *next_)};
        if (task_.beginning != nullptr)
            recorder_.compute_indirect(program, bindings, push_, *task_.beginning);
        else
            recorder_.compute(program, bindings, push_, frame_.extent);
    }

    void begin_at_end() {
        if (task_.begin_at_end.words.empty()) return;
        const Buffer& ended = start_pixel_list(recorder_, frame_, "paths that begin at their end");
        recorder_.compute(program(task_.begin_at_end), {frame_.bindings(), all_of(group_), updates("EndedList", ended)},
                          push_, frame_.extent);
        ended_ = &ended;
        end(ended, false);
    }

    /// Before paths go on: the host finds what those of the list may meet. Where there are none any more, nothing is left to
    /// do but to close.
    void find_on_host(bool first) {
        const PathsOnHost paths{.list = PixelListOnHost(*next_),
                                .width = frame_.extent.width,
                                .places = reinterpret_cast<const glm::vec4*>(places_.mapped()),
                                .ways = reinterpret_cast<const glm::vec4*>(ways_buffer_.mapped()),
                                .media = reinterpret_cast<std::uint32_t*>(media_.mapped()),
                                .words = words_,
                                .coincidence = push_.coincidence,
                                .touching = !topology_.all_alone};
        const CandidatesOnHost candidates{
            reinterpret_cast<CandidateList*>(map_.texels->mapped()),
            {reinterpret_cast<Candidate*>(map_.records->mapped()), map_.records->size() / sizeof(Candidate)}};
        const bool each_begins = first && push_.eye_differs != 0;
        recorder_.on_host([=, finder = finder_, ended = PixelListOnHost(*ended_), all = lists_] {
            if (paths.list.pixels().empty()) {
                for (const Buffer* left : all)
                    PixelListOnHost(*left).set_size(0);  // what an earlier pass has left there
                return false;
            }
            if (each_begins) finder->find_media(paths);
            finder->find(paths, candidates, ended);
            return true;
        });
    }

    void follow(std::uint32_t pass, const Buffer& aside) {
        const Buffer& list = *next_;
        next_ = &start_pixel_list(recorder_, frame_, kListNames[1 - pass % 2]);
        recorder_.compute_indirect(
            program(follow_shader()),
            {frame_.bindings(), all_of(group_), all_of(volume_group_), reads("PixelList", list),
             updates("NextList", *next_), updates("EndedList", *ended_), updates("SetAside", aside)},
            push_, list);
    }

    void end(const Buffer& list, bool closing) {
        PathPush push = push_;
        push.closing = closing ? 1 : 0;
        recorder_.compute_indirect(program(task_.end),
                                   {frame_.bindings(), all_of(group_), all_of(volume_group_), reads("PixelList", list),
                                    updates("NextList", closing ? *ended_ : *next_)},
                                   push, list);
    }

    Recorder& recorder_;
    const Frame& frame_;
    LayerSource& source_;
    const PathTask& task_;
    SurfaceMap map_;
    Lost lost_;
    const std::optional<SurfaceMap> finishing_;  ///< for paths that `map_` has lost
    const HostFinder* finder_;
    const AccelerationStructure* hierarchy_;  ///< in which the device traces rays; null: it does not
    const SceneTopology& topology_;
    PathPush push_;
    const std::uint32_t words_;
    std::uint32_t surfaces_per_pass_ = 1;
    const bool on_host_ = frame_.workspace.device().is_cpu();
    const Buffer& places_ = frame_.workspace.buffer("path places", pixels() * 16, on_host_);
    const Buffer& ways_buffer_ = frame_.workspace.buffer("path ways", pixels() * 16, on_host_);
    const Buffer& weights_ = frame_.workspace.buffer("path weights", pixels() * 16);
    const Buffer& media_ = frame_.workspace.buffer("path media", pixels() * 4 * (words_ + 1), on_host_);
    const Buffer& waiting_ = frame_.workspace.buffer("waiting branches", pixels() * 8);
    const Buffer* branches_ = nullptr;
    std::array<const Buffer*, 2> lists_{};  ///< of paths, which take turns
    const Buffer* next_ = nullptr;          ///< one of them
    const Buffer* ended_ = nullptr;
    const Buffer* aside_ = nullptr;  ///< paths that the map has lost
    std::vector<Binding> group_;     ///< of all passes
    // Something has to be bound where there are no volumes.
    const std::vector<Binding> volume_group_ =
        task_.volumes != nullptr ? task_.volumes->bindings() : std::vector{reads("Volumes", *map_.maps)};
};

}  // namespace

SurfaceFinder SurfaceFinder::of_device(Recorder& recorder, const Frame& frame, LayerSource& source) {
    if (frame.workspace.device().is_cpu() && !frame.recorded)
        return on_host(static_cast<const HostFinder&>(*frame.scene.host_finder));
    return {.map = source.map_meshes(recorder, frame, kMeshMapResolution)};
}

SurfaceFinder SurfaceFinder::on_host(const HostFinder& finder) {
    return {.map = of_triangles(finder.triangles(), finder.normals()), .host = &finder};
}

SurfaceFinder SurfaceFinder::traced(Recorder& recorder, const Frame& frame, const SceneHierarchy& hierarchy) {
    return {.map = place_triangles(recorder, frame), .hierarchy = &hierarchy.top()};
}

void follow(Recorder& recorder, const Frame& frame, LayerSource& source, const SurfaceFinder& finder,
            const PathTask& task) {
    Paths(recorder, frame, source, finder, task).follow();
}

}  // namespace pellucid
