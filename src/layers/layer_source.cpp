#include "layers/layers.h"

namespace pellucid {

Layers LayerSource::build(Recorder& recorder, const Frame& frame, const Opaque& opaque, const LayerRequest& request) {
    const Recorder::Scope scope(recorder, "layers");
    switch (builder_) {
        case LayerBuilder::kDepthPeeling:
            return peel(recorder, frame, opaque, request);
        case LayerBuilder::kSinglePass:
            break;
    }
    return gather(recorder, frame, opaque, request);
}

}  // namespace pellucid
