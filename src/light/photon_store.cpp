#include "light/photon_store.h"

#include "light/shaders.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace pellucid {
namespace {

/// Twins in photons.glsl.
struct PhotonGrid {
    float least_radius, unit;
    std::uint32_t levels, slot_mask;
};
constexpr vk::DeviceSize kSlotSize = 16;

/// The brightest contribution counts 2^44 units: 2^20 of them fit, and the faintest that shows is counted finely.
constexpr float kUnitsOfBrightest = 17592186044416.0f;

constexpr const char* kPhotons = "photons";
constexpr const char* kEntries = "entries of photons";

}  // namespace

const Buffer& PhotonStore::begin(Recorder& recorder, const Frame& frame, LayerSource& source, std::uint64_t guess) {
    const bool on_host = frame.workspace.device().is_cpu();
    photons_ = &source.counted(kPhotons, sizeof(Photon), {}, on_host).begin(recorder, frame.workspace, guess);
    return *photons_;
}

void PhotonStore::build(Recorder& recorder, const Frame& frame, LayerSource& source, const PhotonScale& scale) {
    Workspace& workspace = frame.workspace;
    CountedBuffer& photons = source.counted(kPhotons, sizeof(Photon));
    photons.end(recorder);
    const Recorder::Scope scope(recorder, "photon store");
    const std::uint32_t slots = std::bit_ceil(2 * photons.capacity());
    const Buffer& cells = workspace.buffer("cells of photons", sizeof(PhotonGrid) + slots * kSlotSize);
    const Buffer& header = workspace.buffer("grid of photons", sizeof(PhotonGrid), true);
    const float brightest = scale.most_flux / (scale.least_radius * scale.least_radius);
    const PhotonGrid grid{scale.least_radius, std::max(brightest, 1e-30f) / kUnitsOfBrightest, 0, slots - 1};
    std::memcpy(header.mapped(), &grid, sizeof(grid));
    recorder.fill(cells, 0);
    recorder.copy(header, cells, sizeof(grid));
    const Buffer& groups = photons.groups(recorder, workspace);
    recorder.compute_indirect(workspace.compute(shaders::count_photons_comp),
                              {reads("Photons", *photons_), updates("PhotonCells", cells)}, groups);
    CountedBuffer& entries = source.counted(kEntries, sizeof(glm::uvec2));
    const Buffer& list = entries.begin(recorder, workspace, 4 * std::uint64_t(photons.capacity()));
    const std::uint32_t row = std::min(slots, 1u << 16);
    recorder.compute(workspace.compute(shaders::allocate_cells_comp),
                     {updates("PhotonCells", cells), updates("PhotonEntries", list)}, row, {row, slots / row});
    recorder.compute_indirect(
        workspace.compute(shaders::place_photons_comp),
        {frame.bindings(), reads("Photons", *photons_), updates("PhotonCells", cells), updates("PhotonEntries", list)},
        groups);
    entries.end(recorder);
    bindings_ = {reads("PhotonCells", cells), reads("PhotonEntries", list), reads("Photons", *photons_)};
}

std::vector<Binding> photon_bindings(const Frame& frame) {
    if (frame.photons != nullptr) return *frame.photons;
    const Buffer& none = frame.workspace.buffer("no photons", 16);
    return {reads("PhotonCells", none), reads("PhotonEntries", none), reads("Photons", none)};
}

}  // namespace pellucid
