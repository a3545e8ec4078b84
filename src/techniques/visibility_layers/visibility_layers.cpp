#include "techniques/visibility_layers/visibility_layers.h"

#include "layers/map_building.h"
#include "layers/pixel_list.h"
#include "techniques/shaders.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

namespace pellucid {
namespace {

/// That there is time for beyond those of the longest path, for each branch: most branches leave soon.
constexpr std::uint32_t kSurfacesPerBranch = 4;
/// That there is time for on the longest path where solids overlap: most surfaces there are inside of something.
constexpr std::uint32_t kSurfacesPerEvent = 4;
/// That there is time for on the longest path, besides its surfaces: a path leaves a volume at each surface in it.
constexpr std::uint32_t kVolumesPerPath = 16;

/// Surfaces that a path meets in one dispatch. Each dispatch waits for its longest path: the fewer, the less a GPU idles;
/// on a CPU device eight paths in step wait for the longest among them, so those that have ended had better be left out.
constexpr std::uint32_t kSurfacesPerPass = 16;
constexpr std::uint32_t kSurfacesPerPassOnCpu = 4;

constexpr std::array<const char*, 2> kListNames = {"paths 0", "paths 1"};

/// Words of PathMedia per path.
std::uint32_t words_of(const SceneTopology& topology) { return std::max((topology.slot_count + 31) / 32, 1u); }

/// What becomes of paths that the map loses: they end there, or are set aside for another.
enum class Lost { kEnd, kSetAside };

enum class Ways { kTransmitted, kTree, kStochastic };

class Paths {
public:
    Paths(Recorder& recorder, const Frame& frame, const Layers& layers, const SurfaceMap& map,
          const ParameterValues& parameters, const PathVolumes* volumes, const HostFinder* finder,
          const AccelerationStructure* hierarchy, Lost lost = Lost::kEnd, const SurfaceMap* finishing = nullptr)
        : recorder_(recorder), frame_(frame), layers_(layers), map_(&map), lost_(lost), finishing_(finishing),
          volumes_(volumes), finder_(finder), hierarchy_(hierarchy), topology_(*frame.scene.topology),
          refraction_(clear_refraction(recorder, frame, true)) {
        const double given = parameters["branches"];
        const bool many = frame.samples > 1;
        push_.max_events = parameters.whole("events");
        push_.most_branches = given >= 0.0 ? std::uint32_t(given) : many ? 16 : 0;
        if (volumes != nullptr) volumes->set(push_);
        push_.threshold = float(parameters["threshold"]);
        push_.whole_picture = volumes != nullptr || topology_.eye_in_solid || topology_.eye_differs ? 1 : 0;
        push_.eye_differs = topology_.eye_differs ? 1 : 0;
        push_.eye_depth = topology_.eye_depth;
        push_.largest_contact = topology_.largest_contact;
        push_.coincidence = 1e-6f * (glm::length(frame.scene.bounds.center) + frame.scene.bounds.radius);
        surfaces_per_pass_ = finder != nullptr ? 1 : parameters.whole("surfaces-per-pass");
        if (surfaces_per_pass_ == 0)
            surfaces_per_pass_ = frame.workspace.device().is_cpu() ? kSurfacesPerPassOnCpu : kSurfacesPerPass;
        ways_ = parameters.whole("one-branch") != 0             ? Ways::kStochastic
                : push_.most_branches > 0 || volumes != nullptr ? Ways::kTree
                                                                : Ways::kTransmitted;
        if (ways_ == Ways::kStochastic) push_.most_branches = 0;
        words_ = words_of(topology_);
    }

    Refraction follow() {
        begin_branches();
        group_ = path_bindings();
        // Something has to be bound where there are no volumes.
        volume_group_ = volumes_ != nullptr ? volumes_->bindings() : std::vector{reads("Volumes", *map_->maps)};
        for (std::size_t i = 0; i < lists_.size(); ++i) lists_[i] = &start_pixel_list(recorder_, frame_, kListNames[i]);
        next_ = lists_[0];
        if (push_.whole_picture != 0 || !topology_.all_alone)
            begin_at_eye();
        else
            begin();
        // Ends that lead to nothing else are done all at once.
        const bool at_once = ways_ != Ways::kTree && frame_.scene.opaque.empty() && volumes_ == nullptr;
        if (at_once) ended_ = &start_pixel_list(recorder_, frame_, "ended paths");
        walk(at_once);
        if (lost_ == Lost::kSetAside) finish_lost(at_once);
        if (at_once) end(*ended_, false);
        if (ways_ == Ways::kTree) branches().end(recorder_);
        Refraction refraction = refraction_;
        if (ways_ != Ways::kTransmitted || push_.whole_picture != 0) refraction.reflected = &reflected_;
        if (push_.whole_picture != 0) refraction.picture = refraction.radiance;
        return refraction;
    }

private:
    /// Takes the paths that the map has lost to their ends, if there is another map; says how many they are.
    void finish_lost(bool at_once) {
        LayerSource& source = layers_.source;
        recorder_.read<std::uint32_t>(*aside_, kListLengthOffset,
                                      [&source](std::uint32_t count) { source.note_lost_paths(count); });
        if (finishing_ == nullptr) return;
        lost_ = Lost::kEnd;
        map_ = finishing_;
        group_ = path_bindings();
        next_ = aside_;
        walk(at_once);
    }

    /// Takes the paths of `next_` from surface to surface until all have ended, or the map has lost them.
    void walk(bool at_once) {
        if (lost_ == Lost::kSetAside) aside_ = &start_pixel_list(recorder_, frame_, "lost paths");
        for (std::uint32_t pass = 0; pass < pass_count(); ++pass) {
            if (!at_once) ended_ = &start_pixel_list(recorder_, frame_, "ended paths");
            const Buffer& aside = lost_ == Lost::kSetAside ? *aside_ : start_entering();
            if (finder_ != nullptr) find_on_host(pass == 0);
            follow(pass, aside);
            if (volumes_ != nullptr) volumes_->march(this->pass(), aside, *next_, *ended_);
            if (!at_once) end(*ended_, false);
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
        if (volumes_ != nullptr)
            return std::max(in_passes(surfaces), push_.max_events + kVolumesPerPath) +
                   push_.most_branches * kSurfacesPerBranch;
        return in_passes(surfaces) + push_.most_branches * in_passes(kSurfacesPerBranch + surfaces_per_pass_ - 1);
    }

    std::uint64_t pixels() const { return std::uint64_t(frame_.extent.width) * frame_.extent.height; }

    std::vector<Constant> constants() const {
        const GpuScene& scene = frame_.scene;
        return {{"kMediumWords", words_},
                {"kOneObject", scene.object_count == 1},
                {"kTree", ways_ == Ways::kTree},
                {"kStochastic", ways_ == Ways::kStochastic},
                {"kDispersive", scene.dispersive},
                {"kRough", scene.rough_glass},
                {"kEnvironmentKind", frame_.environment_kind},
                {"kOpaqueObjects", !scene.opaque.empty()},
                {"kMapPerMesh", map_->objects != nullptr},
                {"kFinished", lost_ == Lost::kSetAside},
                {"kTouching", !topology_.all_alone},
                {"kSurfacesPerPass", surfaces_per_pass_},
                {"kVolumes", volumes_ != nullptr},
                {"kManySlots", topology_.many_slots},
                {"kTexturedGlass", scene.textured_glass},
                {"kCrossing", topology_.crossing},
                {"kFoundOnHost", finder_ != nullptr}};
    }
    const Program& program(ShaderCode shader) { return frame_.workspace.compute(shader, constants()); }

    PathPass pass() const { return {recorder_, frame_, constants(), all_of(group_), push_}; }

    /// By the names of visibility_bindings.glsl, path_state.glsl, path_walk.glsl and path_light.glsl.
    std::vector<Binding> path_bindings() const {
        std::vector<Binding> bindings = {
            updates("PathPlaces", places_),
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
            reads("Maps", *map_->maps),
            reads("map_triangles", *map_->triangles),
            reads("map_normals", *map_->normals),
            reads("texels", *map_->texels),
            reads("ranges", *map_->ranges),
            reads("records", *map_->records),
            reads("pyramid", *map_->pyramid),
            reads("MappedObjects", map_->objects != nullptr ? *map_->objects : *map_->maps),
            reads("candidate_lists", *map_->texels),
            reads("candidates", *map_->records),
            layers_.bindings(),
            refraction_.bindings(),
            updates("path_radiance", *refraction_.radiance),
            updates("reflected_radiance", reflected_)};
        if (hierarchy_ != nullptr) bindings.push_back(reads("hierarchy", *hierarchy_));
        return bindings;
    }
    ShaderCode follow_shader() const {
        if (volumes_ != nullptr) return volumes_->follow_shader();
        return hierarchy_ != nullptr ? shaders::follow_traced_paths_comp : shaders::follow_paths_comp;
    }

    CountedBuffer& branches() {
        const std::uint32_t vectors = 4 + (words_ + 1) / 4;  // kBranchVectors of path_state.glsl
        return layers_.source.counted("branches", vectors * 16);
    }
    void begin_branches() {
        branches_ = &frame_.workspace.buffer("no branches", 16);  // something has to be bound
        if (ways_ != Ways::kTree) return;
        branches_ = &branches().begin(recorder_, frame_.workspace, pixels() / 4 + 1024);
        push_.branch_capacity = branches().capacity();
    }

    const Buffer& start_entering() const {
        // Something has to be bound where no path enters anything.
        return volumes_ != nullptr ? start_pixel_list(recorder_, frame_, "paths that enter volumes") : *ended_;
    }

    void begin() {
        recorder_.compute_indirect(program(shaders::begin_paths_comp),
                                   {frame_.bindings(), all_of(group_), updates("NextList", *next_)}, push_,
                                   layers_.covered);
    }

    void begin_at_eye() {
        recorder_.compute(
            program(hierarchy_ != nullptr ? shaders::begin_traced_at_eye_comp : shaders::begin_at_eye_comp),
            {frame_.bindings(), all_of(group_), all_of(volume_group_), updates("NextList", *next_)}, push_,
            frame_.extent);
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
            reinterpret_cast<CandidateList*>(map_->texels->mapped()),
            {reinterpret_cast<Candidate*>(map_->records->mapped()), map_->records->size() / sizeof(Candidate)}};
        const bool each_begins = first && topology_.eye_differs;
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
        recorder_.compute_indirect(program(volumes_ != nullptr ? volumes_->end_shader() : shaders::end_paths_comp),
                                   {frame_.bindings(), all_of(group_), all_of(volume_group_), reads("PixelList", list),
                                    updates("NextList", closing ? *ended_ : *next_)},
                                   push, list);
    }

    Recorder& recorder_;
    const Frame& frame_;
    const Layers& layers_;
    const SurfaceMap* map_;
    Lost lost_;
    const SurfaceMap* finishing_;  ///< for paths that `map_` has lost
    const PathVolumes* volumes_;
    const HostFinder* finder_;
    const AccelerationStructure* hierarchy_;  ///< in which the device traces rays; null: it does not
    const SceneTopology& topology_;
    Refraction refraction_;
    Ways ways_ = Ways::kTransmitted;
    PathPush push_{};
    std::uint32_t words_ = 1;
    std::uint32_t surfaces_per_pass_ = 1;
    const bool on_host_ = frame_.workspace.device().is_cpu();
    const Buffer& places_ = frame_.workspace.buffer("path places", pixels() * 16, on_host_);
    const Buffer& ways_buffer_ = frame_.workspace.buffer("path ways", pixels() * 16, on_host_);
    const Buffer& weights_ = frame_.workspace.buffer("path weights", pixels() * 16);
    const Buffer& media_ = frame_.workspace.buffer("path media", pixels() * 4 * (words_of(topology_) + 1), on_host_);
    const Buffer& waiting_ = frame_.workspace.buffer("waiting branches", pixels() * 8);
    const Buffer* branches_ = nullptr;
    const GpuImage& reflected_ =
        frame_.workspace.image("reflected radiance", vk::Format::eR32G32B32A32Sfloat, frame_.extent);
    std::array<const Buffer*, 2> lists_{};  ///< of paths, which take turns
    const Buffer* next_ = nullptr;          ///< one of them
    const Buffer* ended_ = nullptr;
    const Buffer* aside_ = nullptr;              ///< paths that the map has lost
    std::vector<Binding> group_, volume_group_;  ///< of all passes
};

Refraction record(Recorder& recorder, const Frame& frame, const Layers& layers, const ParameterValues& parameters) {
    const auto map_meshes = [&] { return layers.source.map_meshes(recorder, frame, kMeshMapResolution); };
    // Paths in glass that lies partly beside the view, or around the eye, would leave a map of the view.
    if (!LayerSource::view_holds_glass(frame)) return follow_paths(recorder, frame, layers, map_meshes(), parameters);
    const SurfaceMap map = layers.source.map_view(recorder, frame);
    if (parameters["finish"] == 0.0) return follow_paths(recorder, frame, layers, map, parameters);
    std::optional<SurfaceMap> meshes;
    if (layers.source.finishes_paths()) meshes = map_meshes();
    const Recorder::Scope scope(recorder, "trace");
    return Paths(recorder, frame, layers, map, parameters, nullptr, nullptr, nullptr, Lost::kSetAside,
                 meshes ? &*meshes : nullptr)
        .follow();
}

constexpr auto kParameters = path_parameters_and(
    {"finish", "", 1, 0, 1, true,
     "1: paths that the view's map loses, as beyond the edge of the view, are finished by maps of the meshes"});

}  // namespace

void prepare_paths(const Preparation& preparation, const ParameterValues&) {
    preparation.gpu_scene.prepare_topology(preparation.device, preparation.scene);
}

Refraction follow_paths(Recorder& recorder, const Frame& frame, const Layers& layers, const SurfaceMap& map,
                        const ParameterValues& parameters, const PathVolumes* volumes) {
    const Recorder::Scope scope(recorder, "trace");
    return Paths(recorder, frame, layers, map, parameters, volumes, nullptr, nullptr).follow();
}

Refraction follow_paths(Recorder& recorder, const Frame& frame, const Layers& layers, const HostFinder& finder,
                        const ParameterValues& parameters) {
    const Recorder::Scope scope(recorder, "trace");
    const std::uint64_t pixels = std::uint64_t(frame.extent.width) * frame.extent.height;
    CountedBuffer& counted = layers.source.counted("candidates", sizeof(Candidate), kMapPairFormat, true);
    const Buffer& candidates = counted.begin(recorder, frame.workspace, pixels + pixels / 4 + 1024);
    const Buffer& lists =
        frame.workspace.buffer("candidate lists", pixels * sizeof(CandidateList), true, kMapPairFormat);
    SurfaceMap map = of_triangles(finder.triangles(), finder.normals());
    map.texels = &lists;
    map.records = &candidates;
    const Refraction refraction = Paths(recorder, frame, layers, map, parameters, nullptr, &finder, nullptr).follow();
    counted.end(recorder);
    return refraction;
}

Refraction follow_paths(Recorder& recorder, const Frame& frame, const Layers& layers, const SceneHierarchy& hierarchy,
                        const ParameterValues& parameters) {
    const Recorder::Scope scope(recorder, "trace");
    const SurfaceMap map = place_triangles(recorder, frame);
    return Paths(recorder, frame, layers, map, parameters, nullptr, nullptr, &hierarchy.top()).follow();
}

constexpr Technique kVisibilityLayers{
    .info = {.name = "visibility-layers",
             .summary = "every interface, found in lists of triangles per texel that are made anew in every frame",
             .source = {},
             .parameters = kParameters,
             .many_media = true,
             .whole_scene = true},
    .programs = kPathPrograms,
    .layer_count = [](const ParameterValues& parameters) { return parameters.whole("layers"); },
    .prepare = prepare_paths,
    .record = record,
};

}  // namespace pellucid
