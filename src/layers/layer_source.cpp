#include "layers/layers.h"

namespace pellucid {

Layers LayerSource::build(Recorder& recorder, const Frame& frame, const Opaque& opaque, const LayerRequest& request) {
    const Recorder::Scope scope(recorder, "layers");
    switch (builder_) {
        case LayerBuilder::kDepthPeeling:
            return peel(recorder, frame, opaque, request);
        case LayerBuilder::kDualDepthPeeling:
            return peel_dual(recorder, frame, opaque, request);
        case LayerBuilder::kCompute:
            return select_from_map(recorder, frame, opaque, request);
        case LayerBuilder::kSinglePass:
            break;
    }
    return gather(recorder, frame, opaque, request);
}

bool LayerSource::must_repeat(const Frame& frame) {
    switch (builder_) {
        case LayerBuilder::kDepthPeeling:
            return false;
        case LayerBuilder::kDualDepthPeeling:
            return must_peel_more(frame);
        case LayerBuilder::kCompute:
            return must_enlarge_map(frame);
        case LayerBuilder::kSinglePass:
            break;
    }
    return must_enlarge_pool(frame);
}

}  // namespace pellucid
