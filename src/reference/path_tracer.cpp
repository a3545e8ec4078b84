#include "reference/path_tracer.h"

#include "reference/camera_rays.h"
#include "reference/emitter_sampler.h"
#include "reference/environment_sampler.h"
#include "reference/path_walk.h"
#include "reference/photon_emission.h"
#include "reference/photon_kernel.h"
#include "reference/random.h"
#include "reference/start_media.h"
#include "scene/check_scene.h"

#include <pellucid/error.h>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <vector>

namespace pellucid::reference {
namespace {

constexpr std::uint32_t kTile = 16;  ///< side of a thread's tile, pixels

void check(const PathTraceSettings& s) {
    if (s.width == 0 || s.height == 0) throw Error(fmt::format("a picture of {}x{} has no pixels", s.width, s.height));
    const auto& of_pixels = s.samples_of_pixels;
    if (s.samples == 0 || std::find(of_pixels.begin(), of_pixels.end(), 0u) != of_pixels.end())
        throw Error("path tracing needs at least 1 sample");
    if (!of_pixels.empty() && of_pixels.size() != std::size_t(s.width) * s.height)
        throw Error(fmt::format("{} numbers of samples for {}x{} pixels", of_pixels.size(), s.width, s.height));
    if (s.max_vertices == 0) throw Error("a path needs at least 1 vertex");
}

/// Mean and its standard error, updated value by value without cancellation (Welford 1962).
class RunningMean {
public:
    void add(const glm::dvec3& value) {
        ++count_;
        const glm::dvec3 before = value - mean_;
        mean_ += before / double(count_);
        squares_ += before * (value - mean_);
    }
    glm::dvec3 mean() const { return mean_; }
    glm::dvec3 standard_error() const {
        if (count_ < 2) return glm::dvec3(0.0);
        return glm::sqrt(squares_ / (double(count_) * double(count_ - 1)));
    }

private:
    std::uint64_t count_ = 0;
    glm::dvec3 mean_{0.0}, squares_{0.0};
};

class MeanParts {
public:
    void add(const LightParts& parts) {
        for (std::size_t part = 0; part < parts.size(); ++part) sums_[part] += parts[part];
        ++count_;
    }
    glm::dvec3 mean(std::size_t part) const { return sums_[part] / double(std::max(count_, 1u)); }

private:
    LightParts sums_{};
    std::uint32_t count_ = 0;
};

void store(Image& image, glm::uvec2 pixel, const glm::dvec3& value) {
    float* to = image.at(int(pixel.x), int(pixel.y));
    for (int c = 0; c < 3; ++c) to[c] = float(value[c]);
}

class Painter {
public:
    Painter(const PathWorld& world, const CameraRays& rays, const PathTraceSettings& settings)
        : world_(world), rays_(rays), settings_(settings),
          media_(world.geometry, rays, {settings.width, settings.height}) {
        const std::size_t pixels = std::size_t(settings.width) * settings.height;
        if (world.photons) means_.resize(pixels);
        if (settings.parts) parts_.resize(pixels);
    }

    /// Number of rounds for an image: one per sample if each sample has its own photons, else 1.
    std::uint32_t rounds() const {
        if (!world_.photons) return 1;
        const auto& of_pixels = settings_.samples_of_pixels;
        return of_pixels.empty() ? settings_.samples : *std::max_element(of_pixels.begin(), of_pixels.end());
    }

    /// Traces the samples of one pixel and round. Returns the number of cut paths.
    std::uint64_t paint(glm::uvec2 pixel, std::uint32_t round, PathWalk& walk, PathTracedImage& image) {
        const std::uint64_t index = std::uint64_t(pixel.y) * settings_.width + pixel.x;
        RunningMean of_one_round;
        RunningMean& mean = means_.empty() ? of_one_round : means_[index];
        std::uint64_t cut = 0;
        const bool alike = settings_.samples_of_pixels.empty();
        const std::uint32_t samples = alike ? settings_.samples : settings_.samples_of_pixels[index];
        const std::uint32_t first = world_.photons ? round : 0;
        const std::uint32_t end = world_.photons ? std::min(round + 1, samples) : samples;
        for (std::uint32_t sample = first; sample < end; ++sample) {
            Random random(settings_.seed, index, std::uint64_t(settings_.first_sample) + sample);
            const CameraRay ray = rays_.at(glm::dvec2(pixel) + random.next2());
            const PathWalk::Result result = walk.walk(ray, media_.around(ray), random);
            mean.add(result.radiance);
            if (settings_.parts) parts_[index].add(result.parts);
            cut += result.cut ? 1 : 0;
        }
        store(image.radiance, pixel, mean.mean());
        store(image.standard_error, pixel, mean.standard_error());
        for (std::size_t part = 0; settings_.parts && part < image.parts.size(); ++part)
            store(image.parts[part], pixel, parts_[index].mean(part));
        return cut;
    }

    std::uint64_t paint_tile(glm::uvec2 first, std::uint32_t round, PathTracedImage& image) {
        PathWalk walk(world_);
        const glm::uvec2 end = glm::min(first + kTile, glm::uvec2(settings_.width, settings_.height));
        std::uint64_t cut = 0;
        for (std::uint32_t y = first.y; y < end.y; ++y) {
            for (std::uint32_t x = first.x; x < end.x; ++x) cut += paint({x, y}, round, walk, image);
        }
        return cut;
    }

private:
    const PathWorld& world_;
    const CameraRays& rays_;
    const PathTraceSettings& settings_;
    StartMedia media_;
    std::vector<MeanParts> parts_;    ///< per pixel; empty: not requested
    std::vector<RunningMean> means_;  ///< per pixel, over the rounds; empty: one round only
};

/// Successive rounds of photons, each for one sample of every pixel.
class PhotonRounds {
public:
    PhotonRounds(const Geometry& geometry, const CurvedVolumes& volumes, const Scene& scene, const CameraRays& rays,
                 const PathTraceSettings& settings)
        : geometry_(geometry), rays_(rays), settings_(settings) {
        if (!scene.lights.empty()) emitter_.emplace(geometry, volumes, scene);
    }
    /// Null if no photons are requested, or no light reaches a smooth surface.
    const PhotonMap* map() const { return settings_.photons > 0 && emitter_ && !emitter_->dark() ? &map_ : nullptr; }
    /// Warnings about light that is lost without photons.
    std::vector<std::string> warnings() const {
        if (settings_.photons > 0 || !emitter_) return {};
        const std::vector<std::string> names = emitter_->without_size();
        if (names.empty()) return {};
        return {
            fmt::format("{} without a size: no light of {} comes through smooth glass or volumes, or from mirrors, "
                        "without photons ({})",
                        names.size() == 1 ? "1 light is" : fmt::format("{} lights are", names.size()),
                        names.size() == 1 ? "it" : "them", fmt::join(names, ", "))};
    }

    void shoot(const PathWorld& world, std::uint32_t round) {
        if (!map()) return;
        const std::uint32_t of_all = settings_.first_sample + round;
        const double radius = photon_radius(emitter_->first_radius(settings_.photons), of_all);
        std::vector<Photon> photons = shoot_photons(world, *emitter_, settings_.photons, settings_.seed, of_all);
        spread_over_receivers(geometry_, rays_, radius, settings_.seed, photons);
        map_ = PhotonMap(std::move(photons));
    }

private:
    const Geometry& geometry_;
    const CameraRays& rays_;
    const PathTraceSettings& settings_;
    std::optional<PhotonEmitter> emitter_;
    PhotonMap map_;
};

}  // namespace

PathTracedImage trace_paths(const Geometry& geometry, const CurvedVolumes& volumes, const Scene& scene,
                            const Camera& camera, const Environment& environment, const PathTraceSettings& settings,
                            std::uint32_t threads, const Progress& progress) {
    check(settings);
    check_camera(camera);
    check_environment(environment);
    PathTracedImage image;
    image.samples = settings.samples;
    image.radiance = Image(int(settings.width), int(settings.height), 3);
    image.standard_error = image.radiance;
    if (settings.parts) image.parts.fill(image.radiance);

    const EnvironmentSampler sampler(environment);
    const EmitterSampler emitters(geometry, scene);
    const CameraRays rays(camera, settings.width, settings.height);
    PhotonRounds photons(geometry, volumes, scene, rays, settings);
    image.warnings = photons.warnings();
    const PathWorld world{.geometry = geometry,
                          .volumes = volumes,
                          .scene = scene,
                          .environment = environment,
                          .sampler = sampler,
                          .max_vertices = settings.max_vertices,
                          .has_panes = has_panes(geometry),
                          .photons = photons.map(),
                          .emitters = emitters.dark() ? nullptr : &emitters};
    Painter painter(world, rays, settings);
    const std::uint32_t rounds = painter.rounds();
    const std::uint32_t columns = (settings.width + kTile - 1) / kTile;
    const std::uint32_t tiles = columns * ((settings.height + kTile - 1) / kTile);
    std::mutex mutex;
    std::uint64_t done = 0;
    const auto paint_tile = [&](std::uint32_t tile, std::uint32_t round) {
        const std::uint64_t cut = painter.paint_tile(kTile * glm::uvec2(tile % columns, tile / columns), round, image);
        const std::lock_guard lock(mutex);
        image.cut_paths += cut;
        if (progress) progress(double(++done) / (double(tiles) * rounds));
    };
    tbb::task_arena arena(threads > 0 ? int(threads) : tbb::task_arena::automatic);
    arena.execute([&] {
        for (std::uint32_t round = 0; round < rounds; ++round) {
            photons.shoot(world, round);
            tbb::parallel_for(0u, tiles, [&](std::uint32_t tile) { paint_tile(tile, round); });
        }
    });
    return image;
}

}  // namespace pellucid::reference
