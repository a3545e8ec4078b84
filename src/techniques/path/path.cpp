#include "techniques/path/path.h"

namespace pellucid {
namespace {

constexpr ParameterInfo kParameters[] = {
    kMaxEvents,
    {.name = "seed",
     .unit = "",
     .default_value = 1,
     .minimum = 0,
     .maximum = 4294967295.0,
     .whole = true,
     .doc = "of the random numbers"},
    {.name = "vertices",
     .unit = "",
     .default_value = 256,
     .minimum = 2,
     .maximum = 65535,
     .whole = true,
     .doc = "surfaces after which a path is cut"},
    {.name = "photons",
     .unit = "",
     .default_value = 20000,
     .minimum = 0,
     .maximum = 10000000.0,
     .whole = true,
     .doc = "per sample, for caustics of suns, lamps and spots; 0: none"},
};

PathTracedImage trace_image(const TracedView& view, const Environment& environment, const PictureSamples& samples,
                            const ParameterValues& parameters) {
    return view.tracer.path_trace(view.camera, environment,
                                  {.width = view.picture.x,
                                   .height = view.picture.y,
                                   .samples = samples.count,
                                   .samples_of_pixels = samples.of_pixels,
                                   .first_sample = samples.first,
                                   .seed = parameters.whole("seed"),
                                   .max_vertices = parameters.whole("vertices"),
                                   .photons = parameters.whole("photons"),
                                   .parts = samples.parts},
                                  view.progress);
}

}  // namespace

constexpr Truth kPath{
    .info = {.name = "path",
             .summary = "path tracing on the CPU: all light, converging with the samples",
             .source = {.authors = "James T. Kajiya",
                        .title = "The rendering equation",
                        .venue = "SIGGRAPH",
                        .year = 1986,
                        .section = ""},
             .parameters = kParameters,
             .reference = true,
             .all_light = true,
             .many_media = true,
             .volumes = true,
             .recordable = false},
    .trace_image = trace_image,
};

}  // namespace pellucid
