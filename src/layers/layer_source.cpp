#include "layers/layers.h"

#include <utility>

namespace pellucid {

Layers LayerSource::build(Recorder& recorder, const Frame& frame, const Opaque& opaque, const LayerRequest& request) {
    const Recorder::Scope scope(recorder, "layers");
    switch (builder_) {
        case LayerBuilder::kDepthPeeling:
            return peel(recorder, frame, opaque, request);
        case LayerBuilder::kDualDepthPeeling:
            return peel_dual(recorder, frame, opaque, request);
        case LayerBuilder::kAutomatic:
        case LayerBuilder::kCompute:
        case LayerBuilder::kSinglePass:
            break;
    }
    return gather(recorder, frame, opaque, request);
}

void LayerSource::forget_size() {
    MeshMaps kept = std::move(mesh_maps_);
    *this = LayerSource();
    mesh_maps_ = std::move(kept);
}

bool LayerSource::must_repeat(const Frame& frame) {
    outgrown_.clear();
    const auto note = [&](bool outgrown, const std::string& what) {
        if (outgrown) outgrown_.push_back(what);
    };
    note(std::exchange(repeats_, false), "what the technique keeps");
    note(mesh_maps_.must_repeat(), "maps of meshes");
    note(must_peel_more(), "layers");
    for (auto& [name, buffer] : counted_) note(buffer.grow(), name);
    note(paths_lost_ && !finishes_paths_, "paths that the view's map lost");
    finishes_paths_ = paths_lost_;
    cut_bands(frame);
    return !outgrown_.empty();
}

}  // namespace pellucid
