#include "techniques/kay_greenberg_1979/kay_greenberg_1979.h"
#include "techniques/shaders.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pellucid {
namespace {

constexpr NamedValue kModes[] = {{0, "linear", ""}, {1, "non-linear", ""}, {2, "refraction", ""}};

constexpr std::array kParameters = {
    ParameterInfo{"mode", "", 2, 0, 2, true, "how transparency is found", kModes},
    ParameterInfo{"layers", "", 8, 1, 64, true, "surfaces laid over the background"},
    ParameterInfo{"power", "", 2, 0.01, 100, false, "p of mode non-linear; high for thin glass"},
    ParameterInfo{"min-transparency", "", 0, 0, 1, false, "of a surface seen edge-on, mode non-linear"},
    ParameterInfo{"max-transparency", "", 0.9, 0, 1, false,
                  "of a surface seen from the front, mode non-linear; anywhere, mode linear"},
    ParameterInfo{
        "slab-thickness", "glass radii", 0.1, 0, 100, false,
        "h of mode refraction: of every surface along its normal; in half diagonals of the box around all glass"},
    ParameterInfo{"transmission", "", 0.6, 1e-6, 1, false,
                  "T of mode refraction: share left after one glass radius inside"},
    ParameterInfo{"own-slabs", "", 0, 0, 1, true,
                  "mode refraction: h and T come from each surface's material, glTF's thicknessFactor and attenuation",
                  kOffOn},
    ParameterInfo{"highlight-roughness", "", 0.2, 0.01, 1, false,
                  "of highlights of lights, where the surface is smoother"},
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
    std::uint32_t own_slabs;
    std::uint32_t light_count;
    float least_alpha;
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

Push push_of(const ParameterValues& parameters, const Frame& frame) {
    const double radius = std::max(glass_radius(frame.scene), 1e-30);
    const bool own_slabs = parameters.whole("own-slabs") != 0;
    const double roughness = parameters["highlight-roughness"];
    return {parameters.whole("mode"),
            parameters.whole("layers"),
            float(parameters["power"]),
            float(parameters["min-transparency"]),
            float(parameters["max-transparency"]),
            float(parameters["slab-thickness"] * radius),
            own_slabs ? 0.0f : float(std::log(parameters["transmission"]) / radius),
            own_slabs ? 1u : 0u,
            frame.light.lights,
            float(roughness * roughness)};
}

Refraction record(Recorder& recorder, const Frame& frame, const Layers& layers, const ParameterValues& parameters) {
    const Recorder::Scope scope(recorder, "trace");
    Refraction refraction = clear_refraction(recorder, frame, true);
    const bool lit = frame.light.lights > 0;
    const GpuImage& reflected =
        frame.workspace.image("highlights", vk::Format::eR32G32B32A32Sfloat, lit ? frame.extent : vk::Extent2D{1, 1});
    if (lit) refraction.reflected = &reflected;
    recorder.compute_indirect(frame.workspace.compute(shaders::kay_greenberg_1979_comp, {{"kLit", lit}}),
                              {frame.bindings(), layers.bindings(), refraction.bindings(),
                               writes("path_radiance", *refraction.radiance), writes("reflected_radiance", reflected)},
                              push_of(parameters, frame), layers.covered);
    return refraction;
}

}  // namespace

constexpr Technique kKayGreenberg1979{
    .info = {.name = "kay-greenberg-1979",
             .summary = "surfaces laid over a background image: transparency, and refraction by slabs",
             .source = {"Douglas Scott Kay, Donald Greenberg", "Transparency for Computer Synthesized Images",
                        "SIGGRAPH '79, Computer Graphics 13(2)", 1979, "2 and 4"},
             .parameters = kParameters,
             .opaque_behind = true,
             .lit_glass = true},
    .programs = {&shaders::kay_greenberg_1979_comp},
    // One more tells whether there are surfaces that are not looked at.
    .layer_count = [](const ParameterValues& parameters) { return parameters.whole("layers") + 1u; },
    .record = record,
    .searches_layers = true,
};

}  // namespace pellucid
