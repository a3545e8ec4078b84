#include "techniques/reference/reference.h"

#include <cstring>

namespace pellucid {
namespace {

/// Fills an image of the frame's size with `texel(path)` of every path.
template <class Texel>
void upload_texels(const Frame& frame, const GpuImage& image, const std::vector<RefractedPath>& paths, Texel texel) {
    std::vector<decltype(texel(paths.front()))> texels;
    texels.reserve(paths.size());
    for (const RefractedPath& path : paths) texels.push_back(texel(path));
    upload(frame.workspace.device(), image, 0, std::as_bytes(std::span(texels)));
}

constexpr ParameterInfo kParameters[] = {kMaxEvents};

Refraction record(Recorder&, const Frame& frame, const Layers&, const ParameterValues& parameters) {
    return upload_exact_paths(frame, parameters.whole(kMaxEvents.name));
}

}  // namespace

Refraction upload_exact_paths(const Frame& frame, std::uint32_t max_events) {
    const TracedView& view = *frame.traced;
    const std::vector<RefractedPath> paths = view.tracer.exact(view.camera,
                                                               {.width = view.picture.x,
                                                                .height = view.picture.y,
                                                                .max_events = max_events,
                                                                .shift_px = glm::dvec2(view.jitter_px),
                                                                .part_first = frame.first,
                                                                .part_size = {frame.extent.width, frame.extent.height}},
                                                               view.progress);
    Refraction refraction = allocate_refraction(frame);
    refraction.everywhere = true;
    upload_texels(frame, refraction.exit_direction, paths,
                  [](const RefractedPath& path) { return glm::vec4(path.direction, path.length_inside); });
    upload_texels(frame, refraction.exit_position, paths,
                  [](const RefractedPath& path) { return glm::vec4(path.position, float(path.object)); });
    upload_texels(frame, refraction.transmittance, paths,
                  [](const RefractedPath& path) { return glm::vec4(path.transmittance, 1.0f); });
    upload_texels(frame, refraction.events, paths, [](const RefractedPath& path) {
        return pack_events({path.events, path.reflections, path.status, path.side_conflict});
    });
    return refraction;
}

constexpr Technique kReference{
    .info = {.name = "reference",
             .summary =
                 "exact refraction, traced on the CPU through the triangles: what the others are measured against",
             .source = {},
             .parameters = kParameters,
             .reference = true,
             .many_media = true},
    .layer_count = [](const ParameterValues&) { return 1u; },
    .record = record,
};

}  // namespace pellucid
