// Prepares volumes and opaque objects for light tracing (wavefront.h).
#include "volume/light_buffers.h"
#include "volume/opaque_tree.h"
#include "volume/upload_volumes.h"
#include "volume/wavefront.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace pellucid {
namespace {

constexpr std::size_t kSumBytes = 56, kKeyBytes = 8, kTallyBytes = 16;  // per voxel

std::vector<VolumeRecord> download_records(const Device& device, const VolumeImages& volumes) {
    const std::size_t bytes = volumes.count * sizeof(VolumeRecord);
    const Buffer copy(device, "copy of volumes", bytes, kStorage, true);
    Recorder recorder(device);
    recorder.copy(volumes.records, copy, bytes);
    recorder.submit_and_wait();
    std::vector<VolumeRecord> records(volumes.count);
    std::memcpy(records.data(), copy.mapped(), bytes);
    return records;
}

}  // namespace

void WavefrontTracer::prepare_volumes(const VolumeImages& volumes, const LightSettings& settings) {
    const std::size_t voxel_bytes = settings.kept == KeptLight::kSum ? kSumBytes : kKeyBytes;
    records_ = download_records(device_, volumes);
    smallest_voxel_ = 1e30f;
    std::vector<gpu::LightPlacement> placements;
    std::vector<glm::uvec3> sizes;
    for (const VolumeRecord& record : records_) {
        smallest_voxel_ = std::min(smallest_voxel_, record.voxel);
        sizes.emplace_back(record.size);
    }
    // If one buffer cannot hold all voxels, join eight voxels into one in the largest volumes.
    std::vector<std::uint32_t> halvings(sizes.size(), 0);
    const auto count = [](glm::uvec3 s) { return std::uint64_t(s.x) * s.y * s.z; };
    const auto total = [&] {
        std::uint64_t sum = 0;
        for (const glm::uvec3 size : sizes) sum += count(size);
        return sum;
    };
    const std::uint64_t most = device_.max_storage_binding() / (settings.tally ? kTallyBytes : voxel_bytes);
    coarse_voxels_ = false;
    while (total() > most) {
        const auto largest = std::size_t(
            std::max_element(sizes.begin(), sizes.end(), [&](auto a, auto b) { return count(a) < count(b); }) -
            sizes.begin());
        sizes[largest] = (sizes[largest] + 1u) / 2u;
        ++halvings[largest];
        coarse_voxels_ = true;
    }
    const PackedBoxes boxes = pack_boxes(sizes, device_.limits().maxImageDimension3D);
    std::uint32_t first = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const glm::uvec3 s = sizes[i], at = boxes.first[i];
        placements.push_back({first, s.x, s.y, s.z, at.x, at.y, at.z, halvings[i]});
        first += std::uint32_t(count(s));
    }
    voxels_ = first;
    const vk::ImageUsageFlags usage = vk::ImageUsageFlagBits::eStorage | vk::ImageUsageFlagBits::eSampled |
                                      vk::ImageUsageFlagBits::eTransferSrc | vk::ImageUsageFlagBits::eTransferDst;
    const vk::Extent3D extent{boxes.extent.x, boxes.extent.y, boxes.extent.z};
    light_.irradiance = GpuImage(device_, "irradiance in volumes", vk::Format::eR32G32B32A32Sfloat, extent, usage);
    light_.direction =
        GpuImage(device_, "direction of light in volumes", vk::Format::eR16G16B16A16Sfloat, extent, usage);
    light_.placements = filled(device_, "places of light", placements);
    light_.placement_list = placements;
    voxel_light_ = Buffer(device_, "light of voxels", voxels_ * voxel_bytes, kStorage);
    const std::size_t tally_bytes = settings.tally ? voxels_ * kTallyBytes : kTallyBytes;
    tally_ = Buffer(device_, "tally of light", tally_bytes, kStorage);
    if (settings.tally) tally_copy_ = Buffer(device_, "copy of the tally", tally_bytes, kStorage, true);
}

/// Prepares the opaque triangles. True if they have changed. `key`: encodes everything on which they depend.
bool WavefrontTracer::prepare_opaque(const Scene& scene, std::string key) {
    if (key == opaque_key_) return false;
    const OpaqueTree tree = build_opaque_tree(scene);
    opaque_nodes_ = filled(device_, "boxes of opaque triangles", tree.nodes);
    opaque_triangles_ = filled(device_, "opaque triangles", tree.triangles);
    opaque_count_ = std::uint32_t(tree.nodes.size());
    opaque_key_ = std::move(key);
    return true;
}

/// Initial capacity for photons. A first patch leaves photons along its straight rays and where it lands.
std::uint64_t WavefrontTracer::guessed_photons() const {
    constexpr double kPerPatch = 48.0, kLeast = 4096.0;
    double patches = 0.0;
    for (const gpu::LightFront& front : front_list_.fronts) patches += double(front.corner.w) * double(front.side.w);
    const double guess = opaque_count_ > 0 ? std::max(kPerPatch * patches, kLeast) : 1.0;
    return std::max(std::uint64_t(guess), std::uint64_t(photons_[shown_].store.capacity()));
}

void WavefrontTracer::prepare_lists(std::uint32_t capacity, bool shows) {
    // Several wavefronts are shown at once, so allocate more than one capacity of patches.
    const vk::DeviceSize most = device_.max_storage_binding() / sizeof(gpu::ShownPatch);
    const vk::DeviceSize shown = shows ? std::min<vk::DeviceSize>(4 * vk::DeviceSize(capacity), most) : 1;
    if (light_.shown.size() != shown * sizeof(gpu::ShownPatch))
        light_.shown = Buffer(device_, "wavefronts shown", shown * sizeof(gpu::ShownPatch), kStorage);
    const vk::DeviceSize bytes = vk::DeviceSize(capacity) * sizeof(gpu::LightPatch);
    if (landed_.size() == bytes) return;
    patches_[0] = Buffer(device_, "light patches", bytes, kStorage);
    patches_[1] = Buffer(device_, "other light patches", bytes, kStorage);
    landed_ = Buffer(device_, "landed light", bytes, kStorage);
    step_groups_ = Buffer(device_, "groups of light", 12, kStorage);
    land_groups_ = Buffer(device_, "groups of landed light", 12, kStorage);
}

}  // namespace pellucid
