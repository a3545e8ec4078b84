#pragma once

#include "layers/layers.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pellucid {

/// Irradiance of diffuse surfaces from other surfaces, and their openness to the environment, in a hash of world-space
/// nodes (Binder, Fricke & Keller, "Massively parallel path space filtering", 2019). Every frame sends rays from the
/// surfaces in some of its pixels, and adds the result to earlier frames of the image. The state depends only on the
/// frames drawn, bit for bit.
class IrradianceCache {
public:
    explicit IrradianceCache(const Device& device) : workspace_(device) {}

    /// Call before the frames of an image, when no frame is in flight. `brightness`: irradiance of the scene, W/m2, to
    /// within a factor of 10,000; 0 disables the cache.
    void begin(float brightness);
    bool any() const { return brightness_ > 0.0f; }
    /// Gathers the samples of a frame. Needs GpuScene::topology and, on a CPU device, GpuScene::host_finder. `first`:
    /// first frame of an image or of a tile, which clears the cache.
    void gather(Recorder& recorder, const Frame& frame, bool first);
    /// Call after gather() has run: as LayerSource::must_repeat().
    bool must_repeat() { return gathered_ && source_.must_repeat(*gathered_); }
    /// Call after store() has run too: as LayerSource::must_repeat() for `frame`.
    bool outgrown(const Frame& frame) { return any() && source_.must_repeat(frame); }
    /// Adds the samples of gather() to the cache, which may then be read.
    void store(Recorder& recorder);
    /// Bindings for look-ups, at a constant address; null without a cache.
    const std::vector<Binding>* bindings() const { return any() ? &bindings_ : nullptr; }
    /// Adds a warning if the image exceeded the cache's capacity.
    void report(std::vector<std::string>& warnings) const;
    /// Forgets everything learnt about a scene.
    void forget() { source_ = LayerSource(), gathered_.reset(); }

private:
    void write_grid(Recorder& recorder, const Frame& frame, bool first);

    Workspace workspace_;
    LayerSource source_;
    float brightness_ = 0.0f;
    std::uint32_t frames_ = 0;       ///< frames of the image so far
    std::uint64_t lost_ = 0;         ///< sums without a slot, over the image
    std::optional<Frame> gathered_;  ///< the frame drawn by gather()
    const Buffer* nodes_ = nullptr;
    const Buffer* points_ = nullptr;
    const GpuImage* radiance_ = nullptr;
    const GpuImage* sky_ = nullptr;
    std::vector<Binding> bindings_;
};

}  // namespace pellucid
