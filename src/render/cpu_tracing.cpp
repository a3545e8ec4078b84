#include "render/cpu_tracing.h"

namespace pellucid {

void CpuTracing::set_scene(const Scene& scene) {
    tracer_.reset();
    scene_ = scene;
}

const Tracer& CpuTracing::tracer() {
    if (!tracer_) tracer_.emplace(scene_, TracerOptions{.threads = threads_});
    return *tracer_;
}

}  // namespace pellucid
