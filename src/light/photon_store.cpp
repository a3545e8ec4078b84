#include "light/photon_store.h"

#include "light/shaders.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace pellucid {
namespace {

/// Twin of PhotonGrid in photons.glsl.
struct PhotonGrid {
    float least_radius, unit;
    std::uint32_t levels, slot_mask;
};
constexpr vk::DeviceSize kSlotSize = 16;

/// Units of the brightest contribution: 2^44. So a 64-bit sum holds 2^20 of them, and the faintest visible contribution
/// is still counted in small units.
constexpr float kUnitsOfBrightest = 17592186044416.0f;

}  // namespace

PhotonStore::PhotonStore(const Device& device)
    : list_("photons", sizeof(Photon), {}, device.is_cpu()), entries_("entries of photons", sizeof(glm::uvec2)) {}

const Buffer& PhotonStore::begin(Recorder& recorder, Workspace& workspace, std::uint64_t guess) {
    photons_ = &list_.begin(recorder, workspace, std::min(guess, most_photons(workspace.device())));
    return *photons_;
}

bool PhotonStore::grow() {
    const bool photons = list_.grow();
    return entries_.grow() || photons;
}

/// Largest number of photons for which list and cells fit into memory.
std::uint64_t PhotonStore::most_photons(const Device& device) const {
    const std::uint64_t slots = (device.max_storage_binding() - sizeof(PhotonGrid)) / kSlotSize;
    return std::min<std::uint64_t>(list_.limit(device), std::bit_floor(slots) / 2);
}

double PhotonStore::fit(const Device& device) {
    double share = 1.0;
    for (const auto& [buffer, most] :
         {std::pair(&list_, most_photons(device)), {&entries_, std::uint64_t(entries_.limit(device))}}) {
        if (buffer->capacity() <= most) continue;
        share = std::min(share, double(most) / double(buffer->capacity()));
        buffer->set_capacity(most);
    }
    return share;
}

void PhotonStore::build(Recorder& recorder, Workspace& workspace, const PhotonScale& scale) {
    list_.end(recorder);
    const Recorder::Scope scope(recorder, "photon store");
    const std::uint32_t slots = std::bit_ceil(2 * list_.capacity());
    const Buffer& cells = workspace.buffer("cells of photons", sizeof(PhotonGrid) + slots * kSlotSize);
    const float brightest = scale.most_flux / (scale.least_radius * scale.least_radius);
    const PhotonGrid grid{scale.least_radius, std::max(brightest, 1e-30f) / kUnitsOfBrightest, 0, slots - 1};
    recorder.fill(cells, 0);
    recorder.write(cells, grid);
    const Buffer& groups = list_.groups(recorder, workspace);
    recorder.compute_indirect(workspace.compute(shaders::count_photons_comp),
                              {reads("Photons", *photons_), updates("PhotonCells", cells)}, groups);
    const Buffer& list = entries_.begin(recorder, workspace, 4 * std::uint64_t(list_.capacity()));
    const std::uint32_t row = std::min(slots, 1u << 16);
    recorder.compute(workspace.compute(shaders::allocate_cells_comp),
                     {updates("PhotonCells", cells), updates("PhotonEntries", list)}, row, {row, slots / row});
    recorder.compute_indirect(
        workspace.compute(shaders::place_photons_comp),
        {reads("Photons", *photons_), updates("PhotonCells", cells), updates("PhotonEntries", list)}, scale.sample,
        groups);
    entries_.end(recorder);
    bindings_ = {reads("PhotonCells", cells), reads("PhotonEntries", list), reads("Photons", *photons_)};
}

std::vector<Binding> photon_bindings(const Frame& frame) {
    if (frame.photons != nullptr) return *frame.photons;
    const Buffer& none = frame.workspace.buffer("no photons", 16);
    return {reads("PhotonCells", none), reads("PhotonEntries", none), reads("Photons", none)};
}

}  // namespace pellucid
