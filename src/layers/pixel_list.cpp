#include "layers/pixel_list.h"
#include "layers/shaders.h"

#include <array>

namespace pellucid {
namespace {

constexpr vk::DeviceSize kHeaderWords = 4;  // three arguments of the dispatch, and the length
constexpr std::uint32_t kEverySample = ~0u;
constexpr std::uint32_t kListGroup = 64;  // PELLUCID_LIST_GROUP of pixel_list.glsl

}  // namespace

const Buffer& start_pixel_list(Recorder& recorder, const Frame& frame, std::string_view name) {
    const vk::DeviceSize pixels = vk::DeviceSize(frame.extent.width) * frame.extent.height;
    const Buffer& list = frame.workspace.buffer(name, (kHeaderWords + pixels) * sizeof(std::uint32_t),
                                                frame.workspace.device().is_cpu());
    const vk::DeviceSize row = vk::DeviceSize(kListGroup) * recorder.device().limits().maxComputeWorkGroupCount[0];
    recorder.compute(frame.workspace.compute(shaders::start_list_comp), {writes("PixelList", list)},
                     std::uint32_t((pixels + row - 1) / row), {1, 1});
    return list;
}

const Buffer& list_pixels(Recorder& recorder, const Frame& frame, const GpuImage& marks, std::uint32_t empty,
                          std::string_view name, std::uint32_t first_row, std::uint32_t row_end,
                          const std::optional<WantedSamples>& wanted) {
    const Buffer& list = start_pixel_list(recorder, frame, name);
    recorder.compute(
        frame.workspace.compute(shaders::list_pixels_comp),
        {reads("marks", marks), reads("wanted_samples", wanted ? wanted->counts : marks), updates("PixelList", list)},
        std::array{empty, first_row, row_end, wanted ? wanted->sample : kEverySample},
        {frame.extent.width, row_end - first_row});
    return list;
}

PixelListOnHost::PixelListOnHost(const Buffer& list) : words_(reinterpret_cast<std::uint32_t*>(list.mapped())) {}

std::span<const std::uint32_t> PixelListOnHost::pixels() const { return {data(), words_[kHeaderWords - 1]}; }

std::uint32_t* PixelListOnHost::data() const { return words_ + kHeaderWords; }

void PixelListOnHost::set_size(std::uint32_t size) const {
    const std::uint32_t row = kListGroup * words_[1];
    words_[0] = (size + row - 1) / row;
    words_[kHeaderWords - 1] = size;
}

}  // namespace pellucid
