#include "reference/exact_refraction.h"
#include "reference/float_trace.h"
#include "reference/geometry.h"
#include "reference/light_flux.h"
#include "reference/path_tracer.h"

#include <pellucid/reference.h>

#include <tbb/info.h>

#include <algorithm>
#include <optional>

namespace pellucid {

struct Tracer::Impl {
    const Scene& scene;
    std::uint32_t threads;
    reference::Geometry geometry;
    std::optional<reference::CurvedVolumes> volumes;
};

namespace {

/// Limits threads to cores: TBB has no more, and prints a warning if asked for more.
TracerOptions within_cores(TracerOptions options) {
    const std::uint32_t cores = std::uint32_t(tbb::info::default_concurrency());
    options.threads = options.threads > 0 ? std::min(options.threads, cores) : cores;
    return options;
}

}  // namespace

Tracer::Tracer(const Scene& scene, const TracerOptions& options)
    : impl_(new Impl{scene, within_cores(options).threads, reference::Geometry(scene, within_cores(options)), {}}) {
    impl_->volumes.emplace(scene, impl_->geometry);
}
Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;
Tracer& Tracer::operator=(Tracer&&) noexcept = default;

double Tracer::build_ms() const { return impl_->geometry.build_ms(); }
std::uint32_t Tracer::threads() const { return impl_->threads; }

std::vector<RefractedPath> Tracer::exact(const Camera& camera, const ExactSettings& settings,
                                         const Progress& progress) const {
    return reference::trace_exact(impl_->geometry, *impl_->volumes, camera, settings, impl_->threads, progress);
}

PathTracedImage Tracer::path_trace(const Camera& camera, const Environment& environment,
                                   const PathTraceSettings& settings, const Progress& progress) const {
    return reference::trace_paths(impl_->geometry, *impl_->volumes, impl_->scene, camera, environment, settings,
                                  impl_->threads, progress);
}

std::vector<LightFlux> Tracer::light_flux(std::uint32_t photons, std::uint32_t seed) const {
    return reference::light_flux(impl_->geometry, *impl_->volumes, impl_->scene, photons, seed, impl_->threads);
}

void Tracer::trace_fast(const Camera& camera, const ExactSettings& settings, std::span<glm::vec3> directions) const {
    reference::trace_float(impl_->geometry, camera, settings, impl_->threads, directions);
}

void Tracer::set_positions(const std::vector<MovedMesh>& moved, Update update) {
    impl_->geometry.update(moved, update);
}

}  // namespace pellucid
