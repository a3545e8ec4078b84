#include "bench_timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>

namespace pellucid::cli {
namespace {

constexpr int kFramesPerBlock = 5;  // and traces
constexpr int kDeformations = 5;

double trace_ms(const Tracer& tracer, const Camera& camera, const ExactSettings& exact) {
    const auto start = std::chrono::steady_clock::now();
    tracer.exact(camera, exact);
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void add_frame(AlternatingTimes& times, const std::vector<PassTime>& frame) {
    double total = 0.0;
    for (const PassTime& pass : frame) {
        total += pass.time_ms;
        auto found = std::find_if(times.passes_ms.begin(), times.passes_ms.end(),
                                  [&](const auto& known) { return known.first == pass.name; });
        if (found == times.passes_ms.end()) found = times.passes_ms.insert(found, {pass.name, {}});
        found->second.push_back(pass.time_ms);
    }
    times.frames_ms.push_back(total);
}

/// Median times of moving every vertex a little and of tracing what results.
struct Update {
    double update_ms, trace_ms;
};
Update time_update(const Scene& scene, BuildQuality quality, Tracer::Update how, const Camera& camera,
                   const ExactSettings& exact, std::uint32_t threads) {
    Tracer tracer(scene, {.quality = quality, .deforming = true, .threads = threads});
    std::vector<double> updates, traces;
    for (int i = 0; i < kDeformations; ++i) {
        double update = 0.0;
        for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
            std::vector<glm::vec3> positions = scene.meshes[mesh].positions;
            const float stretch = i % 2 == 0 ? 1.01f : 1.0f;
            for (glm::vec3& position : positions) position.y *= stretch;
            tracer.set_positions(int(mesh), positions, scene.meshes[mesh].normals, how);
            update += tracer.build_ms();
        }
        updates.push_back(update);
        traces.push_back(trace_ms(tracer, camera, exact));
    }
    return {spread(updates).median, spread(traces).median};
}

}  // namespace

AlternatingTimes time_alternately(Renderer& renderer, RenderSettings settings, int frames, const Camera& camera,
                                  const ExactSettings& exact, const Progress& progress) {
    AlternatingTimes times;
    while (int(times.frames_ms.size()) < frames) {
        settings.samples = std::uint32_t(std::min(kFramesPerBlock, frames - int(times.frames_ms.size())));
        for (const std::vector<PassTime>& frame : renderer.render(settings).frames) {
            if (frame.empty()) throw DeviceError(fmt::format("{} has no timestamps", renderer.device().name));
            add_frame(times, frame);
        }
        while (times.traces_ms.size() < times.frames_ms.size())
            times.traces_ms.push_back(trace_ms(renderer.tracer(), camera, exact));
        if (progress) progress(double(times.frames_ms.size()) / frames);
    }
    return times;
}

std::uint32_t fastest_packet(const Tracer& tracer, const Camera& camera, ExactSettings exact) {
    constexpr int kRounds = 2;
    constexpr std::array<std::uint32_t, 4> kPackets{1, 4, 8, 16};
    std::uint32_t best = 1;
    double best_ms = std::numeric_limits<double>::infinity();
    for (int round = 0; round < kRounds; ++round) {
        for (const std::uint32_t packet : kPackets) {
            exact.packet = packet;
            const double ms = trace_ms(tracer, camera, exact);
            if (ms >= best_ms) continue;
            best_ms = ms;
            best = packet;
        }
    }
    return best;
}

DeformingTimes time_deforming(const Scene& scene, const Camera& camera, const ExactSettings& exact,
                              std::uint32_t threads) {
    using How = Tracer::Update;
    // Refitting keeps the shape of the hierarchy: built with care once, it is worth refitting.
    const Update refit = time_update(scene, BuildQuality::kHigh, How::kRefit, camera, exact, threads);
    const Update low = time_update(scene, BuildQuality::kLow, How::kRebuild, camera, exact, threads);
    const Update medium = time_update(scene, BuildQuality::kMedium, How::kRebuild, camera, exact, threads);
    const auto total = [](const Update& update) { return update.update_ms + update.trace_ms; };
    return {.refit_ms = refit.update_ms,
            .rebuild_low_ms = low.update_ms,
            .rebuild_medium_ms = medium.update_ms,
            .best_ms = std::min({total(refit), total(low), total(medium)})};
}

}  // namespace pellucid::cli
