// Adaptive wavefront tracing: Ihrke, Ziegler, Tevs, Theobalt, Magnor, Seidel: Eikonal Rendering, ACM Transactions on
// Graphics 26(3), 2007, section 4.2. docs/eikonal.md describes the differences.
#include "volume/wavefront.h"

#include "volume/light_buffers.h"
#include "volume/light_state.h"
#include "volume/shaders.h"
#include "volume/upload_volumes.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

namespace pellucid {
namespace {

/// Twin of Push in light_patch.glsl.
struct LightPush {
    std::uint32_t capacity, volume_count, opaque_count, front;
    float step, span, least_area;
    std::uint32_t steps_per_round;
    float power_scale;
    float finest, weakest;
    std::uint32_t reflections;
    float shown_spacing, photon_spacing, least_radius, most_photons;
};
struct SumPush {
    std::uint32_t own;
    float irradiance_scale;
};

constexpr double kGuessedIndex = 2.0;  // assumed largest index, for the number of rounds
constexpr double kLeftUnsaid = 0.01;   // share of the power that may remain in flight without a warning
constexpr int kPowerBits = 44;         // bits of the power of all light in fixed point
constexpr float kLeastRadius = 0.25f;  // of a photon's kernel, smallest voxels

template <class T>
void append(std::string& key, const T& value) {
    key.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

std::string volume_key(const VolumeImages& volumes, const LightSettings& settings) {
    std::string key;
    append(key, volumes.records.id());
    append(key, volumes.index.id());
    append(key, settings.kept);
    append(key, settings.tally);
    return key;
}

std::string opaque_key(const Scene& scene, std::uint64_t moves) {
    std::string key;
    append(key, moves);
    for (const Object& object : scene.objects) {
        append(key, object.mesh);
        append(key, scene.materials[std::size_t(object.material)].transmissive());
        append(key, object.world_from_object);
    }
    return key;
}

std::string key_of(const Scene& scene, const LightSettings& s) {
    std::string key;
    for (const float value : {s.step, s.span, s.finest, s.weakest, s.least_area, s.photon_spacing, s.shown_spacing})
        append(key, value);
    for (const std::uint32_t value : {s.capacity, s.steps_per_round, s.rounds, std::uint32_t(s.keep_folds),
                                      std::uint32_t(s.fresnel), s.reflections, std::uint32_t(s.tally)})
        append(key, value);
    for (const Light& light : scene.lights) {
        append(key, light.kind);
        append(key, light.intensity);
        append(key, light.position);
        append(key, light.direction);
        append(key, light.inner_cone_angle);
        append(key, light.outer_cone_angle);
    }
    return key;
}

}  // namespace

std::vector<std::string> LightStatistics::warnings() const {
    std::vector<std::string> lines;
    if (refused > 0)
        lines.push_back(
            fmt::format("light: {} splits and reflections of patches found no room (at most {} at once): light is "
                        "coarser than asked for, or lost at surfaces; raise the capacity",
                        refused, patches));
    if (coarsened) lines.push_back("light: patches began larger than asked for, for want of room; raise the capacity");
    if (coarse_voxels) lines.push_back("light: kept in larger voxels than those of the volumes, for want of room");
    if (not_shown > 0)
        lines.push_back(
            fmt::format("light: {} patches of wavefronts are not shown, for want of room for more than {}; "
                        "raise the spacing or the capacity",
                        not_shown, shown));
    // A little light always circles in solids by total reflection.
    const double share = (left.x + left.y + left.z) / std::max(emitted.x + emitted.y + emitted.z, 1e-300);
    if (share > kLeftUnsaid)
        lines.push_back(
            fmt::format("light: {} patches with {:.3g}% of the power were still on their way after {} rounds",
                        patches_left, 100.0 * share, rounds));
    return lines;
}

/// State of one tracing.
struct WavefrontTracer::Tracing {
    std::string key;
    LightSettings settings;
    std::vector<Light> lights;
    LightPush push;
    std::uint32_t rounds, rounds_done = 0;
    bool overlapping;
};

bool WavefrontTracer::update(Recorder& recorder, Workspace& workspace, const Scene& scene, const VolumeImages& volumes,
                             const LightSettings& settings, std::uint64_t moves) {
    if (settings.tally && settings.kept != KeptLight::kBrightest)
        throw Error("light in volumes: what comes from several directions is counted beside the brightest alone");
    const std::string of_volumes = volume_key(volumes, settings);
    const std::string of_opaque = of_volumes + opaque_key(scene, moves);
    const std::string key = of_opaque + key_of(scene, settings);
    if (of_volumes != volume_key_) pending_.reset();
    if (!pending_ && key == key_) return false;
    if (settings.kept == KeptLight::kBrightest && !device_.long_atomics())
        throw Error(fmt::format("brightest light in volumes: {} lacks 64-bit atomics (shaderBufferInt64Atomics)",
                                device_.info().name));
    const Recorder::Scope scope(recorder, "light");
    if (pending_) {
        const std::shared_ptr<Tracing> tracing = pending_;
        trace_rounds(recorder, workspace, volumes, *tracing, tracing->rounds / tracing->settings.slices + 1, 0);
        if (tracing->rounds_done < tracing->rounds) return true;
        end(recorder, workspace, *tracing);
        finish(recorder, workspace, *tracing);
        pending_.reset();
        return true;
    }

    const bool shows = settings.shown_spacing > 0.0f && !settings.tally;
    bool at_once = settings.slices <= 1 || shows || settings.tally || key_.empty() || lacks_room_;
    if (of_volumes != volume_key_) {
        prepare_volumes(volumes, settings);
        at_once = true;
    }
    volume_key_ = of_volumes;
    at_once = prepare_opaque(scene, of_opaque) || at_once;
    const auto capacity = std::uint32_t(
        std::min<vk::DeviceSize>(settings.capacity, device_.max_storage_binding() / sizeof(gpu::LightPatch)));
    prepare_lists(capacity, shows);
    front_list_ =
        make_fronts(scene.lights, records_,
                    {.side = 0.95f * settings.span, .most_patches = capacity, .per_color = volumes.disperses});
    if (front_list_.fronts.size() > PELLUCID_MOST_FRONTS || volumes.count >= PELLUCID_NO_VOLUME)
        throw Error(
            fmt::format("light in volumes: {} lights and {} volumes are too many (at most {} pairs of one and one)",
                        scene.lights.size(), volumes.count, PELLUCID_MOST_FRONTS));
    fronts_ = filled(device_, "fronts of light", front_list_.fronts);
    state_ = Buffer(device_, "state of light", sizeof(gpu::LightState), kStorage);

    double voxels_across = 0.0;
    for (const VolumeRecord& record : records_) voxels_across += double(glm::length(record.size));
    const double steps = (1.5 + 0.5 * settings.reflections) * kGuessedIndex * voxels_across / double(settings.step);
    const int exponent = kPowerBits - int(std::ceil(std::log2(std::max(front_list_.most_power, 1e-30))));
    const auto tracing = std::make_shared<Tracing>(
        Tracing{.key = key,
                .settings = settings,
                .lights = scene.lights,
                .push = {capacity, volumes.count, opaque_count_, 0, settings.step, settings.span, settings.least_area,
                         settings.steps_per_round, std::ldexp(1.0f, std::min(exponent, 120)), settings.finest,
                         settings.weakest, std::min(settings.reflections, PELLUCID_MOST_REFLECTIONS),
                         shows ? settings.shown_spacing * smallest_voxel_ : 0.0f,
                         settings.photon_spacing * smallest_voxel_, kLeastRadius * smallest_voxel_, most_photons_},
                .rounds = settings.rounds > 0 ? settings.rounds
                                              : std::uint32_t(steps / std::max(1u, settings.steps_per_round)) + 48,
                .overlapping = volumes.overlapping});

    recorder.fill(voxel_light_, 0);
    recorder.fill(tally_, 0);
    recorder.fill(light_.shown, 0);
    // The photons that are shown stay until all slices have run.
    filled_ = at_once ? shown_ : 1 - shown_;
    begin(recorder, workspace, volumes, *tracing);
    if (!at_once) {
        pending_ = tracing;
        trace_rounds(recorder, workspace, volumes, *tracing, tracing->rounds / settings.slices + 1, 0);
        return true;
    }
    trace_rounds(recorder, workspace, volumes, *tracing, tracing->rounds, settings.tally ? 1 : 0);
    end(recorder, workspace, *tracing);
    if (settings.tally) {
        begin(recorder, workspace, volumes, *tracing);
        tracing->rounds_done = 0;
        trace_rounds(recorder, workspace, volumes, *tracing, tracing->rounds, 2);
        end(recorder, workspace, *tracing);
        recorder.copy(tally_, tally_copy_, tally_.size());
    }
    finish(recorder, workspace, *tracing);
    return true;
}

/// Makes the results of a tracing visible.
void WavefrontTracer::finish(Recorder& recorder, Workspace& workspace, const Tracing& tracing) {
    lights_ = tracing.lights;
    resolve_voxels(recorder, workspace, tracing);
    build_photons(recorder, tracing);
    recorder.read<gpu::LightState>(state_, 0,
                                   [this, key = tracing.key, scale = double(tracing.push.power_scale),
                                    tally = tracing.settings.tally](const gpu::LightState& state) {
                                       read_statistics(state, scale, tally);
                                       lacks_room_ = photons_[shown_].store.grow();
                                       if (lacks_room_) leave_fewer_photons(photons_[shown_].store);
                                       if (!lacks_room_) key_ = key;
                                   });
}

/// Reduces the photons per patch of the next tracing if the device does not have the memory for those of this one.
void WavefrontTracer::leave_fewer_photons(PhotonStore& store) {
    constexpr double kMargin = 0.8;
    constexpr float kLeast = 1e-3f;  // photons per patch; below, the patches themselves are too many
    const double share = store.fit(device_);
    if (share < 1.0) most_photons_ *= float(kMargin * share);
    if (most_photons_ < kLeast)
        throw TooLarge(fmt::format("{} has no room for the light of volumes; give fewer patches", device_.info().name));
}

void WavefrontTracer::build_photons(Recorder& recorder, const Tracing& tracing) {
    PhotonScale scale{.least_radius = tracing.push.least_radius, .most_flux = 0.0f};
    for (const gpu::LightFront& front : front_list_.fronts)
        scale.most_flux = std::max(scale.most_flux, front.intensity.w);
    shown_ = filled_;
    photons_[shown_].store.build(recorder, photons_[shown_].workspace, scale);
}

void WavefrontTracer::resolve_voxels(Recorder& recorder, Workspace& workspace, const Tracing& tracing) {
    const bool sums = tracing.settings.kept == KeptLight::kSum;
    const Program& resolve = sums ? workspace.compute(shaders::resolve_summed_light_comp)
                                  : workspace.compute(shaders::resolve_brightest_light_comp);
    const std::vector<Binding> bindings = {
        writes("light_irradiance", light_.irradiance), writes("light_direction", light_.direction),
        reads("Placements", light_.placements), reads(sums ? "Sums" : "Keys", voxel_light_)};
    for (std::uint32_t i = 0; i < light_.placement_list.size(); ++i) {
        const gpu::LightPlacement& own = light_.placement_list[i];
        const vk::Extent2D threads{own.size_x, own.size_y * own.size_z};
        if (!sums) {
            recorder.compute(resolve, bindings, i, threads);
            continue;
        }
        // Sums are power times length in voxels.
        const float joined = std::exp2(3.0f * float(own.halvings)), voxel = records_[i].voxel;
        recorder.compute(resolve, bindings, SumPush{i, 1.0f / (tracing.push.power_scale * joined * voxel * voxel)},
                         threads);
    }
}

void WavefrontTracer::begin_round(Recorder& recorder, Workspace& workspace, const Tracing& tracing) {
    recorder.compute(workspace.compute(shaders::begin_round_comp),
                     {updates("State", state_), writes("StepGroups", step_groups_), writes("LandGroups", land_groups_)},
                     tracing.push, {1, 1});
}

/// Emits the first patches, and subtracts the light that would reach opaque surfaces without volumes.
void WavefrontTracer::begin(Recorder& recorder, Workspace& workspace, const VolumeImages& volumes,
                            const Tracing& tracing) {
    recorder.fill(state_, 0);
    KeptPhotons& photons = photons_[filled_];
    const Buffer& list = photons.store.begin(recorder, photons.workspace, guessed_photons());
    const Program& emit = workspace.compute(shaders::emit_light_comp);
    for (std::uint32_t i = 0; i < front_list_.fronts.size(); ++i) {
        const gpu::LightFront& front = front_list_.fronts[i];
        LightPush own = tracing.push;
        own.front = i;
        recorder.compute(emit,
                         {reads("Volumes", volumes.records), reads("Fronts", fronts_), updates("State", state_),
                          writes("PatchesOut", patches_[0])},
                         own, {std::uint32_t(front.corner.w), std::uint32_t(front.side.w)});
    }
    begin_round(recorder, workspace, tracing);
    recorder.compute_indirect(
        workspace.compute(shaders::land_light_comp, {{"kStraight", true}}),
        {reads("OpaqueNodes", opaque_nodes_), reads("OpaqueTriangles", opaque_triangles_), updates("State", state_),
         reads("Landed", patches_[0]), updates("Photons", list), reads("Fronts", fronts_)},
        tracing.push, step_groups_);
}

void WavefrontTracer::trace_rounds(Recorder& recorder, Workspace& workspace, const VolumeImages& volumes,
                                   Tracing& tracing, std::uint32_t rounds, std::uint32_t tally) {
    const LightPush& push = tracing.push;
    const Program& land = workspace.compute(shaders::land_light_comp, {{"kStraight", false}});
    const std::array constants = {Constant{"kMedium", volumes.absorbs || volumes.scatters},
                                  Constant{"kScatters", volumes.scatters},
                                  Constant{"kOverlapping", tracing.overlapping},
                                  Constant{"kOpaque", push.opaque_count > 0},
                                  Constant{"kKeepFolds", tracing.settings.keep_folds},
                                  Constant{"kBoundary", volumes.reflects && tracing.settings.fresnel},
                                  Constant{"kTally", tally},
                                  Constant{"kShown", push.shown_spacing > 0.0f}};
    std::vector<Binding> step_bindings = {reads("volume_index", volumes.index),
                                          reads("volume_bricks", volumes.bricks),
                                          reads("volume_absorption", volumes.absorption),
                                          reads("volume_scattering", volumes.scattering),
                                          reads("Volumes", volumes.records),
                                          reads("Placements", light_.placements),
                                          reads("OpaqueNodes", opaque_nodes_),
                                          reads("OpaqueTriangles", opaque_triangles_),
                                          reads("Fronts", fronts_),
                                          updates("State", state_),
                                          writes("Landed", landed_),
                                          writes("Shown", light_.shown)};
    const bool sums = tracing.settings.kept == KeptLight::kSum;
    step_bindings.push_back(updates(sums ? "Sums" : "Keys", voxel_light_));
    if (!sums) step_bindings.push_back(updates("Tally", tally_));
    const Program& step = sums ? workspace.compute(shaders::step_summed_light_comp, constants)
                               : workspace.compute(shaders::step_brightest_light_comp, constants);
    const std::uint32_t last = std::min(tracing.rounds, tracing.rounds_done + rounds);
    for (; tracing.rounds_done < last; ++tracing.rounds_done) {
        std::vector<Binding> bindings = step_bindings;
        bindings.push_back(reads("PatchesIn", patches_[tracing.rounds_done % 2]));
        bindings.push_back(writes("PatchesOut", patches_[1 - tracing.rounds_done % 2]));
        recorder.compute_indirect(step, bindings, push, step_groups_);
        begin_round(recorder, workspace, tracing);
        recorder.compute_indirect(
            land,
            {reads("OpaqueNodes", opaque_nodes_), reads("OpaqueTriangles", opaque_triangles_), updates("State", state_),
             reads("Landed", landed_), updates("Photons", photons_[filled_].store.photons()), reads("Fronts", fronts_)},
            push, land_groups_);
    }
}

/// Counts the power of patches that remain.
void WavefrontTracer::end(Recorder& recorder, Workspace& workspace, const Tracing& tracing) {
    recorder.compute_indirect(workspace.compute(shaders::end_light_comp),
                              {updates("State", state_), reads("PatchesIn", patches_[tracing.rounds_done % 2])},
                              tracing.push, step_groups_);
}

void WavefrontTracer::read_statistics(const gpu::LightState& state, double power_scale, bool tally) {
    const auto power = [&](std::uint32_t fate) {
        const auto color = [&](std::uint32_t c) {
            const std::uint32_t* words = &state.power[6 * fate + 2 * c];
            return double(words[0]) + 4294967296.0 * double(words[1]);
        };
        return glm::dvec3(color(0), color(1), color(2)) / power_scale;
    };
    statistics_ = {.emitted = power(PELLUCID_LIGHT_EMITTED),
                   .arrived = power(PELLUCID_LIGHT_ARRIVED),
                   .missed = power(PELLUCID_LIGHT_MISSED),
                   .absorbed = power(PELLUCID_LIGHT_ABSORBED),
                   .reflected = power(PELLUCID_LIGHT_REFLECTED),
                   .turned = power(PELLUCID_LIGHT_TURNED),
                   .weak = power(PELLUCID_LIGHT_WEAK),
                   .left = power(PELLUCID_LIGHT_LEFT),
                   .patches = state.peak,
                   .splits = state.splits,
                   .rounds = state.rounds - (state.left > 0 ? 1u : 0u),  // remaining patches add a round
                   .refused = state.refused,
                   .shown = std::min(state.shown, std::uint32_t(light_.shown.size() / sizeof(gpu::ShownPatch))),
                   .patches_left = state.left,
                   .coarsened = front_list_.coarsened,
                   .coarse_voxels = coarse_voxels_};
    statistics_.not_shown = state.shown - statistics_.shown;
    if (!tally) return;
    double all = 0.0, main = 0.0;
    const auto* sums = reinterpret_cast<const std::uint64_t*>(tally_copy_.mapped());
    for (std::uint64_t voxel = 0; voxel < voxels_; ++voxel) {
        const auto [sum, own] = std::pair(double(sums[2 * voxel]), double(sums[2 * voxel + 1]));
        if (!(sum > 0.0)) continue;
        ++statistics_.lit_voxels;
        if (own > 0.99 * sum) continue;
        ++statistics_.multi_voxels;
        all += 1.0;  // every such voxel has the same weight
        main += own / sum;
    }
    if (all > 0.0) statistics_.main_share = main / all;
}

}  // namespace pellucid
