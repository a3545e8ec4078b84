#include "render/cpu_tracing.h"

#include <utility>

namespace pellucid {

void CpuTracing::set_scene(Scene scene) {
    tracer_.reset();
    scene_ = std::move(scene);
}

const Tracer& CpuTracing::tracer() {
    if (!tracer_) tracer_.emplace(scene_, TracerOptions{.threads = threads_});
    return *tracer_;
}

}  // namespace pellucid
