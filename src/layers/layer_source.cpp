#include "layers/layers.h"

#include <cstring>
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

std::uint32_t LayerSource::room(const std::string& name, std::uint32_t guess) {
    Room& room = rooms_[name];
    if (room.capacity == 0) room.capacity = guess;
    return room.capacity;
}

void LayerSource::measure_room(Recorder& recorder, const Frame& frame, const std::string& name, const Buffer& counter) {
    const Buffer& counted = frame.workspace.buffer(name + " counted", sizeof(std::uint32_t), true);
    recorder.copy(counter, counted, sizeof(std::uint32_t));
    rooms_.at(name).counted = &counted;
}

bool LayerSource::must_enlarge_rooms() {
    bool enlarged = false;
    for (auto& [name, room] : rooms_) {
        if (room.counted == nullptr) continue;
        std::uint32_t needed = 0;
        std::memcpy(&needed, std::exchange(room.counted, nullptr)->mapped(), sizeof(needed));
        if (needed <= room.capacity) continue;
        room.capacity = needed + needed / 4;
        enlarged = true;
    }
    return enlarged;
}

void LayerSource::forget_size() {
    MeshMaps kept = std::move(mesh_maps_);
    *this = LayerSource();
    mesh_maps_ = std::move(kept);
}

bool LayerSource::must_repeat(const Frame& frame) {
    const bool enlarged = must_enlarge_rooms(), meshes = mesh_maps_.must_repeat(), map = must_enlarge_map(frame);
    return must_rebuild_layers(frame) || enlarged || meshes || map;
}

bool LayerSource::must_rebuild_layers(const Frame& frame) {
    switch (builder_) {
        case LayerBuilder::kDepthPeeling:
            return false;
        case LayerBuilder::kDualDepthPeeling:
            return must_peel_more(frame);
        case LayerBuilder::kAutomatic:
        case LayerBuilder::kCompute:
        case LayerBuilder::kSinglePass:
            break;
    }
    return must_enlarge_pool(frame);
}

}  // namespace pellucid
