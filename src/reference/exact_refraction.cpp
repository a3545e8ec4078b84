#include "reference/exact_refraction.h"

#include "reference/camera_rays.h"
#include "reference/exact_path.h"
#include "reference/picture_tiles.h"
#include "reference/start_media.h"
#include "scene/check_scene.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <mutex>

namespace pellucid::reference {
namespace {

glm::uvec2 part_size(const ExactSettings& s) {
    return s.part_size == glm::uvec2(0) ? glm::uvec2(s.width, s.height) : s.part_size;
}

/// Paths of neighbouring pixels, traced in lockstep.
class Block {
public:
    Block(const Geometry& geometry, const CurvedVolumes& volumes, const ExactSettings& settings)
        : geometry_(geometry), volumes_(volumes), settings_(settings), size_(block_size(settings.packet)),
          part_(part_size(settings)),
          paths_(settings.packet, ExactPath(geometry, settings.max_events, int(settings.channel))),
          queries_(settings.packet), active_(settings.packet), hits_(settings.packet) {}

    glm::uvec2 size() const { return size_; }

    /// Calls `store` with the index of each pixel and its path.
    template <class Store>
    void trace(glm::uvec2 first, const CameraRays& rays, const StartMedia& media, const Store& store) {
        std::uint32_t running = 0;
        for (std::uint32_t i = 0; i < settings_.packet; ++i) {
            const glm::uvec2 pixel = first + glm::uvec2(i % size_.x, i / size_.x);
            active_[i] = pixel.x < part_.x && pixel.y < part_.y ? 1 : 0;
            if (active_[i] == 0) continue;
            const CameraRay ray = rays.at(glm::dvec2(settings_.part_first + pixel) + 0.5 + settings_.shift_px);
            paths_[i].start(ray, media.around(ray));
            ++running;
        }
        while (running > 0) running -= step();
        for (std::uint32_t i = 0; i < settings_.packet; ++i) {
            const glm::uvec2 pixel = first + glm::uvec2(i % size_.x, i / size_.x);
            if (pixel.x >= part_.x || pixel.y >= part_.y) continue;
            store(std::size_t(pixel.y) * part_.x + pixel.x, paths_[i]);
        }
    }

private:
    /// Advances every path to its next surface. Returns the number of paths that ended.
    std::uint32_t step() {
        if (!volumes_.empty()) return fly();
        if (settings_.packet == 1) return paths_[0].advance(geometry_.intersect(paths_[0].query())) ? 0 : 1;
        for (std::uint32_t i = 0; i < settings_.packet; ++i) {
            if (active_[i] != 0) queries_[i] = paths_[i].query();
        }
        geometry_.intersect(queries_, active_, hits_);
        std::uint32_t ended = 0;
        for (std::uint32_t i = 0; i < settings_.packet; ++i) {
            if (active_[i] == 0 || paths_[i].advance(hits_[i])) continue;
            active_[i] = 0;
            ++ended;
        }
        return ended;
    }

    /// Advances every path on its own, in scenes with volumes. Returns the number of paths that ended.
    std::uint32_t fly() {
        std::uint32_t ended = 0;
        for (std::uint32_t i = 0; i < settings_.packet; ++i) {
            if (active_[i] == 0 || paths_[i].fly(volumes_)) continue;
            active_[i] = 0;
            ++ended;
        }
        return ended;
    }

    const Geometry& geometry_;
    const CurvedVolumes& volumes_;
    const ExactSettings& settings_;
    glm::uvec2 size_, part_;
    std::vector<ExactPath> paths_;
    std::vector<Query> queries_;
    std::vector<int> active_;
    std::vector<Hit> hits_;
};

/// Traces every path and calls store(index of the pixel, path), from several threads.
template <class Store>
void trace_each(const Geometry& geometry, const CurvedVolumes& volumes, const Camera& camera,
                const ExactSettings& settings, std::uint32_t threads, const Progress& progress, const Store& store) {
    check_camera(camera);
    const CameraRays rays(camera, settings.width, settings.height);
    const StartMedia media(geometry, rays, {settings.width, settings.height});
    const glm::uvec2 size = part_size(settings);
    std::mutex mutex;
    std::uint32_t done = 0;
    for_each_tile(size, threads, [&](glm::uvec2 first, glm::uvec2 end) {
        Block block(geometry, volumes, settings);
        for (std::uint32_t y = first.y; y < end.y; y += block.size().y) {
            for (std::uint32_t x = first.x; x < end.x; x += block.size().x) block.trace({x, y}, rays, media, store);
        }
        if (!progress) return;
        const std::lock_guard lock(mutex);
        progress(double(++done) / double(tile_count(size)));
    });
}

}  // namespace

void check_exact_settings(const ExactSettings& s) {
    if (s.width == 0 || s.height == 0) throw Error(fmt::format("a picture of {}x{} has no pixels", s.width, s.height));
    const glm::uvec2 part = part_size(s);
    if (part.x == 0 || part.y == 0 || s.part_first.x > s.width || s.part_first.y > s.height ||
        part.x > s.width - s.part_first.x || part.y > s.height - s.part_first.y)
        throw Error(fmt::format("{}x{} pixels from {}, {} on are no part of a picture of {}x{}", part.x, part.y,
                                s.part_first.x, s.part_first.y, s.width, s.height));
    if (s.max_events == 0 || s.max_events > 65535) {
        throw Error(fmt::format("the exact path follows 1 to 65535 events, not {}", s.max_events));
    }
    if (s.packet != 1 && s.packet != 4 && s.packet != 8 && s.packet != 16) {
        throw Error(fmt::format("rays are traced in packets of 1, 4, 8 or 16, not {}", s.packet));
    }
    if (s.channel > std::uint32_t(kBlue))
        throw Error(fmt::format("the channels are 0 (red), 1 and 2 (blue), not {}", s.channel));
    if (!std::isfinite(s.shift_px.x) || !std::isfinite(s.shift_px.y)) {
        throw Error("the shift of the primary rays is not finite");
    }
}

std::vector<RefractedPath> trace_exact(const Geometry& geometry, const CurvedVolumes& volumes, const Camera& camera,
                                       const ExactSettings& settings, std::uint32_t threads, const Progress& progress) {
    check_exact_settings(settings);
    const glm::uvec2 size = part_size(settings);
    std::vector<RefractedPath> paths(std::size_t(size.x) * size.y);
    trace_each(geometry, volumes, camera, settings, threads, progress,
               [&](std::size_t i, const ExactPath& path) { paths[i] = path.result(); });
    return paths;
}

std::vector<SurfacePath> trace_surfaces(const Geometry& geometry, const CurvedVolumes& volumes, const Camera& camera,
                                        const ExactSettings& settings, std::uint32_t threads,
                                        const Progress& progress) {
    check_exact_settings(settings);
    const glm::uvec2 size = part_size(settings);
    std::vector<SurfacePath> paths(std::size_t(size.x) * size.y);
    trace_each(geometry, volumes, camera, settings, threads, progress,
               [&](std::size_t i, const ExactPath& path) { paths[i] = path.surfaces(); });
    return paths;
}

}  // namespace pellucid::reference
