#pragma once

#include <pellucid/reference.h>

#include <cstdint>
#include <optional>

namespace pellucid {

/// The scene for techniques that trace on the CPU. Its hierarchy is built when the first of them asks.
class CpuTracing {
public:
    explicit CpuTracing(std::uint32_t threads) : threads_(threads) {}
    CpuTracing(const CpuTracing&) = delete;
    CpuTracing& operator=(const CpuTracing&) = delete;

    void set_scene(Scene scene);
    const Scene& scene() const { return scene_; }
    const Tracer& tracer();

private:
    std::uint32_t threads_;
    Scene scene_;
    std::optional<Tracer> tracer_;  // looks at scene_
};

}  // namespace pellucid
