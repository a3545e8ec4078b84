#include "techniques/photons/photons.h"

#include "gpu/camera_constants.h"
#include "techniques/shaders.h"
#include "techniques/visibility_layers/visibility_layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <string>

namespace pellucid {
namespace {

constexpr vk::DeviceSize kPhotonExitSize = 48;  ///< bytes of PhotonExit in photon_exits.glsl
constexpr std::uint32_t kMostEvents = 64;
/// Radius of a kernel in spacings of photons. In a uniform distribution a look-up finds 12 photons.
constexpr float kKernelWidth = 2.0f;
/// Offset of photon texels, to give photons other random numbers than pixels.
constexpr std::uint32_t kFirstTexel = 1u << 20;

/// Twin of the block in photon_windows.glsl.
struct WindowHeader {
    std::uint32_t side, columns, count;
    float kernel_width, least_radius;
    std::uint32_t lists_straight;
    std::uint32_t reserved[2];
};

/// Factor of radii in sample `sample` of a still (Knaus & Zwicker, "Progressive photon mapping: a probabilistic
/// approach", 2011, equation 15, alpha = 2/3). The mean over the samples converges.
float shrinkage(std::uint32_t sample) {
    constexpr double kAlpha = 2.0 / 3.0;
    double share = 1.0;
    for (std::uint32_t i = 1; i <= sample; ++i) share *= (i + kAlpha) / (i + 1.0);
    return float(std::sqrt(share));
}

std::uint32_t columns_of(std::size_t windows) { return std::uint32_t(std::ceil(std::sqrt(double(windows)))); }

/// Size of a view's texels at its targets, m. It limits the resolution of focused light.
float spacing_of(const LightView& view, const Bounds& bounds) {
    const float texel = std::sqrt(view.constants.film.z * view.constants.film.w);
    if (view.constants.orthographic != 0) return texel;
    return texel * std::max(std::abs(view.target_depth), 1e-3f * bounds.radius);
}

float flux_of(const Light& light, const LightView& view) {
    const glm::vec3 i = light.intensity;
    return std::max({i.r, i.g, i.b}) * view.constants.film.z * view.constants.film.w;
}

/// Flux of a light through a view, W, summed over texels as in begin_at_light.comp.
glm::dvec3 sent_flux(const Light& light, const LightView& view) {
    const glm::dvec4 film(view.constants.film);
    const std::uint32_t side = view.constants.width;
    if (view.constants.orthographic != 0)
        return glm::dvec3(light.intensity) * (film.z * film.w * double(side) * double(side));
    const glm::dmat3 world_from_view(view.constants.world_from_view);
    const PunctualLight own = punctual_light(light);
    double sum = 0.0;
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side; ++x) {
            const glm::dvec3 way(film.x + (x + 0.5) * film.z, film.y - (y + 0.5) * film.w, -1.0);
            const double cosine = 1.0 / glm::length(way);
            double share = 1.0;
            if (light.kind == Light::Kind::kSpot) {
                const double cos_angle = glm::dot(world_from_view * way, glm::dvec3(own.direction)) * cosine;
                share =
                    std::clamp((cos_angle - double(own.cos_outer)) / double(own.cos_inner - own.cos_outer), 0.0, 1.0);
            }
            sum += share * share * cosine * cosine * cosine;
        }
    }
    return glm::dvec3(light.intensity) * (film.z * film.w * sum);
}

bool in_solid(const GpuScene& scene, const Light& light) {
    if (light.kind == Light::Kind::kDirectional) return false;
    for (std::size_t first = 0; first < scene.refractive_corners.size(); first += 8) {
        glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
        for (std::size_t i = first; i < first + 8; ++i) {
            low = glm::min(low, scene.refractive_corners[i]);
            high = glm::max(high, scene.refractive_corners[i]);
        }
        if (glm::all(glm::lessThanEqual(low, light.position)) && glm::all(glm::lessThanEqual(light.position, high)))
            return true;
    }
    return false;
}

}  // namespace

void Photons::begin(PhotonSetup setup) {
    workspace_.trim();
    setup_ = std::move(setup);
    flux_ = {};
}

Frame Photons::light_frame(const Frame& frame) {
    const std::uint32_t side = setup_.side, columns = columns_of(setup_.window_count());
    const std::uint32_t rows = (std::uint32_t(setup_.window_count()) + columns - 1) / columns;
    gpu::FrameConstants values = frame.view;
    values.width = side * columns;
    values.height = side * rows;
    values.first_x = values.first_y = kFirstTexel;
    const Buffer& constants = workspace_.buffer("photon constants", sizeof(values));
    return seen_from(frame, workspace_, constants, values, {values.width, values.height});
}

std::vector<PhotonWindow> Photons::windows_of(const Frame& frame) const {
    using From = PhotonWindow::Source;
    std::vector<PhotonWindow> windows;
    for (const LightView& view : setup_.views) {
        windows.push_back({view.constants.world_from_view, view.constants.film,
                           punctual_light(setup_.lights.at(view.light)), view.constants.orthographic, view.target_depth,
                           From::kLights, 0});
    }
    const Bounds& bounds = frame.scene.bounds;
    PhotonWindow all{};
    all.light.position = setup_.targets.center;
    all.light.radius = setup_.targets.radius;
    all.target_depth = 1.01f * (glm::distance(bounds.center, setup_.targets.center) + bounds.radius);
    for (const From source : {From::kEmitters, From::kEnvironment}) {
        all.source = source;
        if (source == From::kEmitters ? setup_.emitters : setup_.environment != nullptr) windows.push_back(all);
    }
    return windows;
}

/// Sets the scale of the photon store. `width`: width of kernels, in spacings of photons.
void Photons::set_scale(const Frame& frame, float width) {
    scale_ = {std::numeric_limits<float>::max(), 0.0f};
    scale_.sample = frame.view.sample_index;
    for (const LightView& view : setup_.views) {
        scale_.least_radius = std::min(scale_.least_radius, width * spacing_of(view, frame.scene.bounds));
        scale_.most_flux = std::max(scale_.most_flux, flux_of(setup_.lights.at(view.light), view));
    }
    if (!setup_.emitters && setup_.environment == nullptr) return;
    const float count = float(setup_.side) * float(setup_.side),
                area = kPi * setup_.targets.radius * setup_.targets.radius;
    scale_.least_radius = std::min(scale_.least_radius, width * std::sqrt(area / count));
    if (setup_.emitters) scale_.most_flux = std::max(scale_.most_flux, 4.0f * kPi * frame.scene.emitted_power / count);
    // If one texel of a cell of the environment is bright, its photons exceed this mean.
    if (setup_.environment != nullptr)
        scale_.most_flux = std::max(scale_.most_flux, 8.0f * setup_.environment->luminance * area / count);
}

const Buffer& Photons::write_windows(Recorder& recorder, const Frame& frame) {
    const float width = kKernelWidth * shrinkage(frame.samples > 1 ? frame.sample : 0);
    set_scale(frame, width);
    const std::vector<PhotonWindow> windows = windows_of(frame);
    const WindowHeader header{setup_.side, columns_of(windows.size()), std::uint32_t(windows.size()),
                              width,       scale_.least_radius,        counts_ ? 1u : 0u,
                              {}};
    const std::span bytes = std::as_bytes(std::span(windows));
    const Buffer& buffer = workspace_.buffer("photon windows", sizeof(header) + bytes.size());
    recorder.write(buffer, header);
    recorder.write(buffer, bytes, sizeof(header));
    return buffer;
}

const Buffer& Photons::gather_exits(Recorder& recorder, const Frame& from_light, const Buffer& windows) {
    const ParameterValues parameters(setup_.by->info, setup_.parameters);
    const std::uint64_t texels = std::uint64_t(from_light.extent.width) * from_light.extent.height;
    const Buffer& exits = workspace_.buffer("photon exits", texels * kPhotonExitSize);
    recorder.fill(exits, 0);
    for (std::uint32_t number = 0; number < setup_.views.size(); ++number) {
        gpu::FrameConstants values = setup_.views[number].constants;
        values.object_count = from_light.scene.object_count;
        values.sample_index = from_light.view.sample_index;
        shift_film(values, sample_jitter(values.sample_index));
        const Buffer& own = workspace_.buffer("constants of photon view " + std::to_string(number), sizeof(values));
        recorder.write(own, values);
        Frame view = seen_from(from_light, from_light.workspace, own, values, {values.width, values.height});
        const Opaque opaque = setup_.draw_opaque(recorder, view);
        const Layers hidden =
            source_.build(recorder, view, opaque, {view.scene.refractive, setup_.by->layer_count(parameters)});
        // The technique must find the exits from glass, not the surfaces behind them.
        const GpuImage& nowhere = workspace_.image("no opaque depth", vk::Format::eR32Sfloat, view.extent);
        recorder.clear(nowhere, vk::ClearColorValue(std::array{float(PELLUCID_EMPTY_DEPTH), 0.0f, 0.0f, 0.0f}));
        const Opaque none{opaque.radiance, nowhere, opaque.object, opaque.triangle};
        const Layers layers{hidden.depth, hidden.triangle, hidden.normal, hidden.covered, hidden.count,
                            none,         hidden.source};
        const Refraction refraction = setup_.by->record(recorder, view, layers, parameters);
        const Recorder::Scope scope(recorder, "photons");
        recorder.compute(workspace_.compute(shaders::gather_exits_comp),
                         {view.bindings(), layers.bindings(), refraction.bindings(), reads("PhotonWindows", windows),
                          updates("PhotonExits", exits)},
                         std::array{number, from_light.extent.width}, view.extent);
    }
    return exits;
}

void Photons::record(Recorder& recorder, const Frame& frame) {
    const Frame from_light = light_frame(frame);
    recorder.write(from_light.constants, from_light.view);
    const Buffer& windows = write_windows(recorder, frame);
    source_.begin_frame(setup_.layer_builder);
    const Buffer& exits = setup_.by != nullptr ? gather_exits(recorder, from_light, windows) : windows;
    {
        const SurfaceFinder finder = SurfaceFinder::of_device(recorder, from_light, source_);
        const Recorder::Scope scope(recorder, "photons");
        const std::uint64_t texels = std::uint64_t(from_light.extent.width) * from_light.extent.height;
        const Buffer& list = store_.begin(recorder, workspace_, texels);
        PathTask task{.begin = shaders::begin_at_light_comp,
                      .end = shaders::end_photons_comp,
                      .bindings = {reads("PhotonWindows", windows), updates("Photons", list),
                                   reads("EnvironmentShares",
                                         setup_.environment != nullptr ? setup_.environment->buffer : windows)},
                      .ways = Ways::kStochastic,
                      .from_light = true};
        if (setup_.by != nullptr) {
            task.begin = shaders::begin_at_exit_comp;
            task.bindings.push_back(updates("PhotonExits", exits));
        }
        task.push.max_events = kMostEvents;
        task.push.whole_picture = 1;
        task.push.emitter_count = setup_.emitters ? frame.scene.emitter_count : 0;
        task.push.eye_differs =
            setup_.emitters_in_solids || std::any_of(setup_.lights.begin(), setup_.lights.end(),
                                                     [&](const Light& light) { return in_solid(frame.scene, light); });
        follow(recorder, from_light, source_, finder, task);
    }
    if (counts_) count(recorder, from_light);
    store_.build(recorder, workspace_, scale_);
    bindings_ = store_.bindings();
}

bool Photons::must_repeat(const Frame& frame) {
    if (!any()) return false;
    const bool crowded = store_.grow();
    return source_.must_repeat(light_frame(frame)) || crowded;
}

void Photons::count(Recorder& recorder, const Frame& from_light) {
    const Buffer& list = store_.photons();
    const Buffer& copy = workspace_.buffer("photons on the host", list.size(), true);
    recorder.copy(list, copy, list.size());
    flux_ = {};
    for (const LightView& view : setup_.views) flux_.sent += sent_flux(setup_.lights.at(view.light), view);
    flux_.objects.assign(from_light.scene.object_count, {});
    recorder.when_done([this, &copy] {
        std::uint32_t count = 0;
        std::memcpy(&count, copy.mapped(), sizeof(count));
        const std::size_t capacity = (copy.size() - kPhotonListHeader) / sizeof(Photon);
        std::vector<Photon> photons(std::min<std::size_t>(count, capacity));
        std::memcpy(photons.data(), copy.mapped() + kPhotonListHeader, photons.size() * sizeof(Photon));
        std::sort(photons.begin(), photons.end(), [](const Photon& a, const Photon& b) { return a.texel < b.texel; });
        for (const Photon& photon : photons) {
            const glm::dvec3 flux(photon.flux);
            if (photon.object == kNotYetLanded)
                flux_.sent += flux;
            else if (photon.object == PELLUCID_NO_TRIANGLE)
                flux_.left += flux;
            else
                (photon.level == kStraightPhoton ? flux_.objects[photon.object].straight
                                                 : flux_.objects[photon.object].bent) += flux;
        }
    });
}

}  // namespace pellucid
