#pragma once

#include <pellucid/animation.h>
#include <pellucid/reference.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pellucid {

/// The scene on the CPU, and the tracer of reference techniques, built on first use.
class CpuTracing {
public:
    explicit CpuTracing(std::uint32_t threads) : threads_(threads) {}
    CpuTracing(const CpuTracing&) = delete;
    CpuTracing& operator=(const CpuTracing&) = delete;

    void set_scene(Scene scene);
    /// Moves vertices; the hierarchy is rebuilt on next use. Throws Error and moves nothing if a mesh does not exist,
    /// the counts differ, or a number is not finite.
    void set_positions(const std::vector<MovedMesh>& moved);
    /// Each setter throws Error and changes nothing if the scene would become invalid.
    void set_transforms(const std::vector<PosedObject>& moved);
    void set_material(int index, const Material& material);
    void set_lights(const std::vector<Light>& lights);
    const Scene& scene() const { return scene_; }
    const Tracer& tracer();

private:
    std::uint32_t threads_;
    Scene scene_;
    std::optional<Tracer> tracer_;  // refers to scene_
};

}  // namespace pellucid
