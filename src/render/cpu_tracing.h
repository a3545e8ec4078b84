#pragma once

#include <pellucid/reference.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pellucid {

/// The scene for techniques that trace on the CPU. Its hierarchy is built when the first of them asks.
class CpuTracing {
public:
    explicit CpuTracing(std::uint32_t threads) : threads_(threads) {}
    CpuTracing(const CpuTracing&) = delete;
    CpuTracing& operator=(const CpuTracing&) = delete;

    void set_scene(Scene scene);
    /// Throws Error, and moves nothing, if a mesh does not exist, the counts differ, or a number is not finite. The
    /// hierarchy is built anew when it is next asked for.
    void set_positions(const std::vector<MovedMesh>& moved);
    void set_lights(const std::vector<Light>& lights);
    const Scene& scene() const { return scene_; }
    const Tracer& tracer();

private:
    std::uint32_t threads_;
    Scene scene_;
    std::optional<Tracer> tracer_;  // looks at scene_
};

}  // namespace pellucid
