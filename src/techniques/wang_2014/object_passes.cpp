#include "techniques/wang_2014/object_passes.h"

#include "layers/pixel_list.h"
#include "techniques/shaders.h"

#include <array>

namespace pellucid {

ObjectPasses::ObjectPasses(Recorder& recorder, const Frame& frame, const Layers& seen, const Layers& layers,
                           const Refraction& refraction, const ObjectSearch& search, const ExitSearch& exits)
    : recorder_(recorder), frame_(frame), seen_(seen), layers_(layers), refraction_(refraction), search_(search),
      exits_(exits), merged_(merge_layers(recorder, frame, layers, exits.silhouettes)) {}

ObjectPasses::MergedLayers ObjectPasses::merge_layers(Recorder& recorder, const Frame& frame, const Layers& layers,
                                                      bool silhouettes) {
    Workspace& workspace = frame.workspace;
    const GpuImage& depth = workspace.image("merged layer depth", vk::Format::eR32Sfloat, frame.extent, layers.count);
    const GpuImage& normal = workspace.image("merged layer normal", vk::Format::eR32Uint, frame.extent, layers.count);
    const Buffer& entry_limit = workspace.buffer("farthest entry", sizeof(std::uint32_t));
    // Beside the object there is neither entry nor exit. A ray there must count as outside: in front of entries and
    // behind exits.
    for (std::uint32_t layer = 0; layer < layers.count; ++layer) {
        const float beside =
            layer % 2 == 0 || !silhouettes ? float(PELLUCID_EMPTY_DEPTH) : -float(PELLUCID_EMPTY_DEPTH);
        recorder.clear_layer(depth, layer, vk::ClearColorValue(std::array{beside, 0.0f, 0.0f, 0.0f}));
    }
    recorder.clear(normal, vk::ClearColorValue(std::array{0u, 0u, 0u, 0u}));
    recorder.fill(entry_limit, 0);
    recorder.compute_indirect(
        workspace.compute(shaders::merge_layers_comp),
        {reads("layer_depth", layers.depth), reads("layer_normal", layers.normal), reads("PixelList", layers.covered),
         writes("merged_depth", depth), writes("merged_normal", normal), updates("EntryLimit", entry_limit)},
        layers.count, layers.covered);
    return {depth, normal, entry_limit};
}

const Buffer& ObjectPasses::enter(const Buffer& pixels, std::uint32_t layer) {
    const Buffer& inside = start_pixel_list(recorder_, frame_, "rays inside");
    search_.layer = layer;
    recorder_.compute_indirect(
        frame_.workspace.compute(shaders::enter_solid_comp,
                                 {{"kNextObject", layer == 0}, {"kCountsSteps", exits_.counts_steps}}),
        {frame_.bindings(), layers_.bindings(), refraction_.bindings(), reads("seen_triangle", seen_.triangle),
         reads("merged_depth", merged_.depth), reads("merged_normal", merged_.normal),
         reads("EntryLimit", merged_.entry_limit), reads("PixelList", pixels), updates("Inside", inside)},
        search_, pixels);
    return inside;
}

const Buffer& ObjectPasses::leave(const Buffer& pixels, std::uint32_t layer, std::uint32_t reflections, bool from_eye) {
    const Buffer& outside = start_pixel_list(recorder_, frame_, "rays outside");
    const Buffer* searching = &pixels;
    search_.layer = layer;
    for (std::uint32_t reflection = 0; reflection <= reflections; ++reflection) {
        search_.last_reflection = reflection == reflections ? 1 : 0;
        const Buffer& reflected =
            start_pixel_list(recorder_, frame_, reflection % 2 == 0 ? "rays reflected" : "rays reflected again");
        recorder_.compute_indirect(
            frame_.workspace.compute(shaders::leave_solid_comp, {{"kFromEye", from_eye && reflection == 0},
                                                                 {"kBelowFaults", exits_.below_faults},
                                                                 {"kFrontExits", exits_.front_exits},
                                                                 {"kSteepWalls", exits_.steep_walls},
                                                                 {"kCountsSteps", exits_.counts_steps}}),
            {frame_.bindings(), layers_.bindings(), refraction_.bindings(), reads("seen_triangle", seen_.triangle),
             reads("merged_depth", merged_.depth), reads("merged_normal", merged_.normal),
             reads("EntryLimit", merged_.entry_limit), reads("PixelList", *searching), updates("Outside", outside),
             updates("Reflected", reflected)},
            search_, *searching);
        searching = &reflected;
    }
    return outside;
}

}  // namespace pellucid
