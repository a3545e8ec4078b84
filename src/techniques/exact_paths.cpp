// Results that reference techniques trace on the host, as images that frames shade.
#include "techniques/truth.h"

#include <cstring>
#include <span>
#include <vector>

namespace pellucid {
namespace {

/// Makes the host fill images of the frame's size, one after the other, through a shared buffer. `trace` gets the
/// buffer's address and returns whether it has filled the buffer.
void fill_on_host(Recorder& recorder, const Frame& frame, std::initializer_list<const GpuImage*> images,
                  const std::function<bool(std::byte*)>& trace) {
    const auto size_of = [](const GpuImage& image) {
        return vk::DeviceSize(image.extent().width) * image.extent().height * texel_size(image.format());
    };
    vk::DeviceSize bytes = 0;
    for (const GpuImage* image : images) bytes += size_of(*image);
    const Buffer& traced = frame.workspace.buffer("traced on the host", bytes, true);
    recorder.on_host([trace, to = traced.mapped()] { return trace(to); });
    vk::DeviceSize offset = 0;
    for (const GpuImage* image : images) {
        recorder.copy(traced, offset, *image);
        offset += size_of(*image);
    }
    recorder.end_of_steps();
}

/// Writes `texel(path)` of every path to `to`, and advances `to` past them.
template <class Texel>
void write_texels(std::byte*& to, const std::vector<RefractedPath>& paths, Texel texel) {
    for (const RefractedPath& path : paths) {
        const auto value = texel(path);
        std::memcpy(to, &value, sizeof(value));
        to += sizeof(value);
    }
}

}  // namespace

Refraction trace_exact_paths(Recorder& recorder, const Frame& frame, const TracedView& view,
                             const ParameterValues& parameters) {
    Refraction refraction = allocate_refraction(frame);
    refraction.everywhere = true;
    const ExactSettings settings{.width = view.picture.x,
                                 .height = view.picture.y,
                                 .max_events = parameters.whole(kMaxEvents.name),
                                 .shift_px = glm::dvec2(view.jitter_px),
                                 .part_first = frame.first,
                                 .part_size = {frame.extent.width, frame.extent.height}};
    fill_on_host(
        recorder, frame,
        {&refraction.exit_direction, &refraction.exit_position, &refraction.transmittance, &refraction.events},
        [view, settings](std::byte* to) {
            const std::vector<RefractedPath> paths = view.tracer.exact(view.camera, settings, view.progress);
            write_texels(to, paths, [](const auto& path) { return glm::vec4(path.direction, path.length_inside); });
            write_texels(to, paths, [](const auto& path) { return glm::vec4(path.position, float(path.object)); });
            write_texels(to, paths, [](const auto& path) { return glm::vec4(path.transmittance, 1.0f); });
            write_texels(to, paths, [](const auto& path) {
                return pack_events({path.events, path.reflections, path.status, path.side_conflict});
            });
            return true;
        });
    return refraction;
}

const GpuImage& trace_sample(Recorder& recorder, const Frame& frame, const Truth& truth, const TracedView& view,
                             const Environment& environment, std::uint32_t sample, const ParameterValues& parameters) {
    const GpuImage& radiance = frame.workspace.image("traced radiance", vk::Format::eR32G32B32A32Sfloat, frame.extent);
    fill_on_host(recorder, frame, {&radiance}, [&truth, view, &environment, sample, parameters](std::byte* to) {
        const Image traced = truth.trace_image(view, environment, {.count = 1, .first = sample}, parameters).radiance;
        for (std::size_t i = 0; i < traced.pixels.size(); i += 3, to += sizeof(glm::vec4)) {
            const glm::vec4 texel(traced.pixels[i], traced.pixels[i + 1], traced.pixels[i + 2], 1.0f);
            std::memcpy(to, &texel, sizeof(texel));
        }
        return true;
    });
    return radiance;
}

}  // namespace pellucid
