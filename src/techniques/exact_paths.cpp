#include "techniques/truth.h"

#include <span>
#include <vector>

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

}  // namespace

Refraction upload_exact_paths(const Frame& frame, const TracedView& view, const ParameterValues& parameters) {
    const std::vector<RefractedPath> paths = view.tracer.exact(view.camera,
                                                               {.width = view.picture.x,
                                                                .height = view.picture.y,
                                                                .max_events = parameters.whole(kMaxEvents.name),
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

}  // namespace pellucid
