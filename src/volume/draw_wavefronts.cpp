#include "volume/draw_wavefronts.h"

#include "volume/light_records.h"
#include "volume/shaders.h"

namespace pellucid {
namespace {

constexpr float kDimmed = 0.25f;  // remaining share of the scene's radiance

}  // namespace

void draw_wavefronts(Recorder& recorder, const Frame& frame, const Buffer& shown, const GpuImage& opaque_depth,
                     const GpuImage& radiance, float exposure) {
    Workspace& workspace = frame.workspace;
    const Recorder::Scope scope(recorder, "wavefronts");
    recorder.compute(workspace.compute(shaders::dim_radiance_comp), {updates("radiance", radiance)}, kDimmed * exposure,
                     frame.extent);
    const Program& draw = workspace.graphics({.vertex = shaders::draw_wavefronts_vert,
                                              .fragment = shaders::draw_wavefronts_frag,
                                              .colors = {vk::Format::eR32G32B32A32Sfloat},
                                              .depth = true});
    const GpuImage& nearest = workspace.image("wavefront depth test", vk::Format::eD32Sfloat, frame.extent);
    // Unused patches have no area, so the draw covers the whole buffer.
    const DrawCall all{0, std::uint32_t(6 * (shown.size() / sizeof(gpu::ShownPatch))), 0};
    recorder.draw(draw, {frame.bindings(), reads("Shown", shown), reads("opaque_depth", opaque_depth)}, exposure,
                  RenderTarget{.extent = frame.extent,
                               .colors = {{&radiance, 0, {}}},
                               .depth = RenderTarget::Attachment{&nearest, 0, clear_to_farthest()}},
                  std::span(&all, 1));
}

}  // namespace pellucid
