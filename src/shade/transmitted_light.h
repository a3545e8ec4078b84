#pragma once

#include "layers/layers.h"
#include "light/light_views.h"

#include <pellucid/thickness.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pellucid {

/// Thickness baked per vertex.
struct LocalThickness {
    Buffer values;  ///< float, m in the frame of each object's mesh
    /// uvec2 per object: index of its first value minus its mesh's first vertex; metres in world space per unit
    Buffer objects;
};

/// Whether a method reads baked values, and no layers.
constexpr bool is_baked(ThicknessMethod method) {
    return method == ThicknessMethod::kLocalThickness || method == ThicknessMethod::kPublishedLocalThickness;
}

/// Lights of an image, and the method that finds their thickness.
struct TransmittedLightSetup {
    ThicknessMethod method = ThicknessMethod::kLayers;
    LayerBuilder builder = LayerBuilder::kSinglePass;  ///< builder of the light's layers
    std::uint32_t layers = 8;
    std::uint32_t resolution = 1024;  ///< texels along a side of a map
    std::vector<Light> lights;
    std::vector<LightView> views;
    const LocalThickness* local = nullptr;  ///< required if is_baked(method)
};

/// Light through translucent solids (Chen). It builds layers from every light, in a frame and layer source of the
/// light's own, and integrates absorption along the light rays. Opaque objects cast shadows on translucent ones; glass
/// does not.
class TransmittedLight {
public:
    explicit TransmittedLight(const Device& device) : workspace_(device) {}

    /// Call before the frames of an image, when no frame is in flight.
    void begin(TransmittedLightSetup setup);
    /// Adds the light to `opaque.radiance` at translucent surfaces.
    void add(Recorder& recorder, const Frame& frame, const Opaque& opaque);
    /// Measures the thickness (R32F) for the lights of the setup: m, kNotTranslucent or kShadowed.
    const GpuImage& measure(Recorder& recorder, const Frame& frame, const Opaque& opaque);
    /// Builds the lights' maps only, for timing. Call it after a frame that need not be repeated.
    void build_maps(Recorder& recorder, const Frame& frame, const Opaque& opaque);
    /// As LayerSource::must_repeat().
    bool must_repeat(const Frame& frame);
    /// Pixels of the last frame whose light ray crosses more surfaces than there are layers.
    std::uint64_t cut_rays() const { return cut_rays_; }
    std::uint32_t geometry_passes() const { return any_ ? source_.geometry_passes() : 0; }
    std::uint32_t view_count() const { return std::uint32_t(setup_.views.size()); }
    /// Forgets everything learnt about a scene.
    void forget();

private:
    struct Surfaces;
    Surfaces draw_surfaces(Recorder& recorder, const Frame& frame, const Opaque& opaque);
    void record(Recorder& recorder, const Frame& frame, const Opaque& opaque, const GpuImage& thickness, bool measures);
    void record_view(Recorder& recorder, const Frame& frame, const Opaque& opaque, const Surfaces& surfaces,
                     const GpuImage& thickness, std::size_t view, bool measures);
    Frame view_from(Recorder& recorder, const Frame& frame, std::size_t number);
    const GpuImage& build_map(Recorder& recorder, const Frame& frame, const Opaque& opaque, std::size_t number);
    /// Layers per light; a shadow map is the first layer.
    std::uint32_t layer_count() const {
        const bool first = setup_.method == ThicknessMethod::kTranslucentShadowMap ||
                           setup_.method == ThicknessMethod::kPublishedShadowMap;
        return first ? 1 : setup_.layers;
    }
    Frame light_frame(const Frame& frame, const Buffer& constants, const gpu::FrameConstants& view) const;
    bool needs_layers() const { return !is_baked(setup_.method); }

    mutable Workspace workspace_;
    LayerSource source_;
    TransmittedLightSetup setup_;
    bool any_ = false;  ///< true if this frame has such light
    std::uint32_t cut_rays_ = 0;
};

}  // namespace pellucid
