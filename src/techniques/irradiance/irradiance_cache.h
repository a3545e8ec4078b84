#pragma once

#include "layers/layers.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pellucid {

/// Irradiance of diffuse surfaces that others send them, and how open they are to the environment, in a hash of world-space nodes (Binder, Fricke & Keller, "Massively
/// parallel path space filtering", 2019). Every frame sends a ray from what some of its pixels show, and adds what the rays find
/// to that of earlier frames of the picture. The state depends on the frames drawn alone, bit for bit.
class IrradianceCache {
public:
    explicit IrradianceCache(const Device& device) : workspace_(device) {}

    /// Before the frames of a picture, when none is in flight. `brightness`: irradiance of the scene, W/m2, to within a factor
    /// of 10,000; 0: the picture has no cache.
    void begin(float brightness);
    bool any() const { return brightness_ > 0.0f; }
    /// Gathers what a frame adds. Needs GpuScene::topology and, on a device that is a CPU, GpuScene::host_finder.
    /// `first`: of the picture or of a tile, which forgets the others.
    void gather(Recorder& recorder, const Frame& frame, bool first);
    /// After gather() has run: as LayerSource::must_repeat().
    bool must_repeat() { return gathered_ && source_.must_repeat(*gathered_); }
    /// Likewise of `frame`, after store() has run, too.
    bool outgrown(const Frame& frame) { return any() && source_.must_repeat(frame); }
    /// Adds what gather() has found; then look-ups may begin.
    void store(Recorder& recorder);
    /// What look-ups bind; its address does not change. Null: there is no cache.
    const std::vector<Binding>* bindings() const { return any() ? &bindings_ : nullptr; }
    /// Adds a line if the picture had more to store than there is room for.
    void report(std::vector<std::string>& warnings) const;
    /// Forgets what it has learnt of a scene.
    void forget() { source_ = LayerSource(), gathered_.reset(); }

private:
    void write_grid(Recorder& recorder, const Frame& frame, bool first);

    Workspace workspace_;
    LayerSource source_;
    float brightness_ = 0.0f;
    std::uint32_t frames_ = 0;       ///< of the picture so far
    std::uint64_t lost_ = 0;         ///< sums without a slot, likewise
    std::optional<Frame> gathered_;  ///< that gather() has drawn
    const Buffer* nodes_ = nullptr;
    const Buffer* points_ = nullptr;
    const GpuImage* radiance_ = nullptr;
    const GpuImage* sky_ = nullptr;
    std::vector<Binding> bindings_;
};

}  // namespace pellucid
