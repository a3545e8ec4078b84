#include "lab/bench_timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <limits>

namespace pellucid::cli {
namespace {

constexpr int kFramesPerBlock = 5;  // and traces per block
constexpr int kDeformations = 5, kBuilds = 3;

using Directions = std::vector<glm::vec3>;

Directions buffer_for(const ExactSettings& settings) {
    return Directions(std::size_t(settings.width) * settings.height);
}

double trace_ms(const TimedTrace& trace, Directions& directions) {
    const auto start = std::chrono::steady_clock::now();
    trace.tracer.trace_fast(trace.camera, trace.settings, directions);
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

/// Moves every vertex of the scene slightly, back or forth. Returns the time of the hierarchy's update, ms.
double deform(Tracer& tracer, const Scene& scene, bool forth, Tracer::Update how) {
    std::vector<std::vector<glm::vec3>> positions;
    std::vector<MovedMesh> moved;
    positions.reserve(scene.meshes.size());  // MovedMesh refers to these vectors
    for (const Mesh& mesh : scene.meshes) {
        positions.push_back(mesh.positions);
        for (glm::vec3& position : positions.back()) position.y *= forth ? 1.01f : 1.0f;
        moved.push_back({int(moved.size()), positions.back(), mesh.normals});
    }
    tracer.set_positions(moved, how);
    return tracer.build_ms();
}

/// Median times of moving every vertex, and of tracing the result.
struct Update {
    double update_ms, trace_ms;
};
Update time_update(const Scene& scene, BuildQuality quality, Tracer::Update how, const Camera& camera,
                   const ExactSettings& settings, std::uint32_t threads) {
    Tracer tracer(scene, {.quality = quality, .deforming = true, .robust = false, .threads = threads});
    const TimedTrace trace{tracer, camera, settings};
    Directions directions = buffer_for(settings);
    deform(tracer, scene, false, how);  // not timed: the first refit after a build is a build
    std::vector<double> updates, traces;
    for (int i = 0; i < kDeformations; ++i) {
        updates.push_back(deform(tracer, scene, i % 2 == 0, how));
        traces.push_back(trace_ms(trace, directions));
    }
    return {spread(updates).median, spread(traces).median};
}

}  // namespace

std::string cpu_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        const std::size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
    }
    return "unknown";
}

AlternatingTimes time_alternately(Renderer& renderer, RenderSettings settings, int frames, const TimedTrace& trace,
                                  const Progress& progress) {
    AlternatingTimes times;
    Directions directions = buffer_for(trace.settings);
    while (int(times.frames_ms.size()) < frames) {
        const int missing = frames - int(times.frames_ms.size());
        // A single sample would differ: it uses pixel centres and no sum.
        settings.still = false;
        settings.samples = std::uint32_t(std::clamp(missing, 2, kFramesPerBlock));
        std::vector<std::vector<PassTime>> drawn = renderer.render(settings).frames;
        drawn.resize(std::min(drawn.size(), std::size_t(missing)));
        for (const std::vector<PassTime>& frame : drawn) {
            if (frame.empty()) throw DeviceError(fmt::format("{} has no timestamps", renderer.device().name));
            add_frame(times, frame);
        }
        while (times.traces_ms.size() < times.frames_ms.size()) times.traces_ms.push_back(trace_ms(trace, directions));
        if (progress) progress(double(times.frames_ms.size()) / frames);
    }
    return times;
}

std::uint32_t fastest_packet(TimedTrace trace) {
    constexpr int kRounds = 3;
    constexpr std::array<std::uint32_t, 4> kPackets{1, 4, 8, 16};
    Directions directions = buffer_for(trace.settings);
    std::uint32_t best = 1;
    double best_ms = std::numeric_limits<double>::infinity();
    for (int round = 0; round < kRounds; ++round) {
        for (const std::uint32_t packet : kPackets) {
            trace.settings.packet = packet;
            const double ms = trace_ms(trace, directions);
            if (ms >= best_ms) continue;
            best_ms = ms;
            best = packet;
        }
    }
    return best;
}

TimedTracer build_timed(const Scene& scene, std::uint32_t threads) {
    const TracerOptions options{.robust = false, .threads = threads};
    TimedTracer timed{Tracer(scene, options), 0.0};
    std::vector<double> builds;
    for (int i = 0; i < kBuilds; ++i) {
        timed.tracer = Tracer(scene, options);
        builds.push_back(timed.tracer.build_ms());
    }
    timed.build_ms = spread(builds).median;
    return timed;
}

DeformingTimes time_deforming(const Scene& scene, const Camera& camera, const ExactSettings& settings,
                              std::uint32_t threads) {
    using How = Tracer::Update;
    // The build quality does not affect a refit: the first refit builds the hierarchy, of medium quality, that later
    // refits keep.
    const Update refit = time_update(scene, BuildQuality::kMedium, How::kRefit, camera, settings, threads);
    const Update low = time_update(scene, BuildQuality::kLow, How::kRebuild, camera, settings, threads);
    const Update medium = time_update(scene, BuildQuality::kMedium, How::kRebuild, camera, settings, threads);
    const auto total = [](const Update& update) { return update.update_ms + update.trace_ms; };
    return {.refit_ms = refit.update_ms,
            .rebuild_low_ms = low.update_ms,
            .rebuild_medium_ms = medium.update_ms,
            .best_ms = std::min({total(refit), total(low), total(medium)})};
}

}  // namespace pellucid::cli
