#include "viewer/overlay.h"

#include "report/color_scale.h"

#include <pellucid/names.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace pellucid::viewer {
namespace {

constexpr std::array kOverlays{
    OverlayInfo{"error", "error of the exit direction: dark 0.01 degrees, bright 180 degrees, logarithmic"},
    OverlayInfo{"status", "dark ok; then missing layer, left screen, step limit; brightest event limit"},
    OverlayInfo{"layers", "glass surfaces along the view ray: dark 1, bright 16 and more"},
    OverlayInfo{"thickness", "length of the path inside glass: dark 0, bright 4 radii of the scene"},
    OverlayInfo{"caustic", "light that glass throws onto surfaces, of the technique path alone"},
};
constexpr float kMostLayers = 16.0f;
constexpr float kMostRadii = 4.0f;
constexpr std::uint32_t kExactEvents = 64;

void set(Image& image, std::size_t pixel, const glm::vec3& color) {
    std::copy_n(&color.x, 3, image.pixels.data() + 3 * pixel);
}

/// Colours of values from 0 to `most`. Pixels without glass, whose number of layers is 0, are neutral.
Image colored(const Image& values, const Image& layers, float most) {
    const ColorScale scale;
    Image image(values.width, values.height, 3);
    for (std::size_t i = 0; i < values.pixels.size(); ++i)
        set(image, i, layers.pixels[i] > 0.0f ? scale.at(values.pixels[i] / most) : kUncoveredColor);
    return image;
}

Image draw_errors(Renderer& renderer, const Camera& camera, RenderSettings settings) {
    settings.paths = true;
    const std::vector<RefractedPath> drawn = renderer.render(settings).paths;
    ExactSettings exact;
    exact.width = settings.width;
    exact.height = settings.height;
    exact.max_events = kExactEvents;
    const float height = 2.0f * std::tan(0.5f * camera.vertical_fov) / float(settings.height);
    const PixelFootprint footprint = camera.orthographic
                                         ? PixelFootprint{camera.vertical_extent / float(settings.height), 0.0f}
                                         : PixelFootprint{0.0f, height};
    return color_errors(path_error_image(int(settings.width), int(settings.height),
                                         renderer.tracer().exact(camera, exact), drawn, footprint));
}

float srgb_encoded(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

Image draw_caustics(Renderer& renderer, RenderSettings settings) {
    settings.technique = "path";
    settings.parameters.clear();
    settings.aovs = {"caustic"};
    Image image = renderer.render(settings).aovs.at("caustic");
    const float factor = std::exp2(settings.exposure_ev);
    for (float& value : image.pixels) value = srgb_encoded(std::clamp(factor * value, 0.0f, 1.0f));
    return image;
}

}  // namespace

std::span<const OverlayInfo> overlay_infos() { return kOverlays; }

const OverlayInfo& find_overlay(std::string_view name) {
    std::vector<std::string_view> known;
    for (const OverlayInfo& each : kOverlays) {
        if (each.name == name) return each;
        known.push_back(each.name);
    }
    throw unknown_name("overlay", name, known);
}

Image draw_overlay(std::string_view name, Renderer& renderer, const Camera& camera, const Bounds& bounds,
                   RenderSettings settings) {
    find_overlay(name);
    settings.samples = 1;
    settings.view = View::kRadiance;
    if (name == "error") return draw_errors(renderer, camera, settings);
    if (name == "caustic") return draw_caustics(renderer, settings);
    const std::string aov(name == "thickness" ? "path-length" : name);
    settings.aovs = {"layers"};
    if (aov != "layers") settings.aovs.push_back(aov);
    const RenderResult result = renderer.render(settings);
    const float most = name == "status"   ? float(kStatusCount - 1)
                       : name == "layers" ? kMostLayers
                                          : kMostRadii * std::max(bounds.radius, 1e-6f);
    return colored(result.aovs.at(aov), result.aovs.at("layers"), most);
}

}  // namespace pellucid::viewer
