#pragma once

#include <pellucid/animation.h>
#include <pellucid/reference.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pellucid {

/// The scene on the CPU, and the tracer of truths. Its hierarchy is built when it is first asked for.
class CpuTracing {
public:
    explicit CpuTracing(std::uint32_t threads) : threads_(threads) {}
    CpuTracing(const CpuTracing&) = delete;
    CpuTracing& operator=(const CpuTracing&) = delete;

    void set_scene(Scene scene);
    /// Throws Error, and moves nothing, if a mesh does not exist, the counts differ, or a number is not finite. The
    /// hierarchy is built anew when it is next asked for.
    void set_positions(const std::vector<MovedMesh>& moved);
    /// Throw Error, and change nothing, if what they give would be no valid scene.
    void set_transforms(const std::vector<PosedObject>& moved);
    void set_material(int index, const Material& material);
    void set_lights(const std::vector<Light>& lights);
    const Scene& scene() const { return scene_; }
    const Tracer& tracer();

private:
    std::uint32_t threads_;
    Scene scene_;
    std::optional<Tracer> tracer_;  // looks at scene_
};

}  // namespace pellucid
