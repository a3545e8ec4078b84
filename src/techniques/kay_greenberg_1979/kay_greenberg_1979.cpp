#include "techniques/kay_greenberg_1979/kay_greenberg_1979.h"
#include "techniques/shaders.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pellucid {
namespace {

constexpr std::array kParameters = {
    ParameterInfo{"mode", "", 2, 0, 2, true, "0 linear, 1 non-linear, 2 refraction"},
    ParameterInfo{"layers", "", 8, 1, 64, true, "surfaces laid over the background"},
    ParameterInfo{"power", "", 2, 0.01, 100, false, "p of mode 1; high for thin glass"},
    ParameterInfo{"min-transparency", "", 0, 0, 1, false, "of a surface seen edge-on, mode 1"},
    ParameterInfo{"max-transparency", "", 0.9, 0, 1, false,
                  "of a surface seen from the front, mode 1; anywhere, mode 0"},
    ParameterInfo{"slab-thickness", "glass radii", 0.1, 0, 100, false,
                  "h of mode 2: of every surface along its normal; in half diagonals of the box around all glass"},
    ParameterInfo{"transmission", "", 0.6, 1e-6, 1, false, "T of mode 2: share left after one glass radius inside"},
};

/// Twin of Push in the shader.
struct Push {
    std::uint32_t mode;
    std::uint32_t surfaces;
    float power;
    float min_transparency;
    float max_transparency;
    float thickness;
    float log_transmission;
};

/// Half the diagonal of the box around all glass, m.
double glass_radius(const GpuScene& scene) {
    if (scene.refractive_corners.empty()) return 0.0;
    glm::vec3 low = scene.refractive_corners.front(), high = low;
    for (const glm::vec3& corner : scene.refractive_corners) {
        low = glm::min(low, corner);
        high = glm::max(high, corner);
    }
    return 0.5 * double(glm::distance(low, high));
}

Push push_of(const ParameterValues& parameters, const GpuScene& scene) {
    const double radius = std::max(glass_radius(scene), 1e-30);
    return {parameters.whole("mode"),
            parameters.whole("layers"),
            float(parameters["power"]),
            float(parameters["min-transparency"]),
            float(parameters["max-transparency"]),
            float(parameters["slab-thickness"] * radius),
            float(std::log(parameters["transmission"]) / radius)};
}

Refraction record(Recorder& recorder, const Frame& frame, const Layers& layers, const ParameterValues& parameters) {
    const Recorder::Scope scope(recorder, "trace");
    const Refraction refraction = clear_refraction(recorder, frame, true);
    recorder.compute_indirect(
        frame.workspace.compute(shaders::kay_greenberg_1979_comp),
        {frame.bindings(), layers.bindings(), refraction.bindings(), writes("path_radiance", *refraction.radiance)},
        push_of(parameters, frame.scene), layers.covered);
    return refraction;
}

}  // namespace

constexpr Technique kKayGreenberg1979{
    .info = {.name = "kay-greenberg-1979",
             .summary = "surfaces laid over a background image: transparency, and refraction by slabs",
             .source = {"Douglas Scott Kay, Donald Greenberg", "Transparency for Computer Synthesized Images",
                        "SIGGRAPH '79, Computer Graphics 13(2)", 1979, "2 and 4"},
             .parameters = kParameters,
             .opaque_behind = true},
    .programs = {&shaders::kay_greenberg_1979_comp},
    // One more tells whether there are surfaces that are not looked at.
    .layer_count = [](const ParameterValues& parameters) { return parameters.whole("layers") + 1u; },
    .record = record,
    .searches_layers = true,
};

}  // namespace pellucid
