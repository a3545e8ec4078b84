#include <pellucid/renderer.h>

#include "render/aovs.h"
#include "render/approximations.h"
#include "render/camera_constants.h"
#include "render/frame.h"
#include "scene/check_scene.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

namespace pellucid {
namespace {

constexpr std::uint32_t kMaxSamples = 1u << 20;

template <class Enum, std::size_t kCount>
Enum parse_name(std::string_view what, std::string_view name,
                const std::array<std::pair<std::string_view, Enum>, kCount>& known) {
    std::vector<std::string_view> names;
    for (const auto& [text, value] : known) {
        if (text == name) return value;
        names.push_back(text);
    }
    throw Error(fmt::format("unknown {} '{}'; known: {}", what, name, fmt::join(names, ", ")));
}

void check_settings(const RenderSettings& settings, const Device& device) {
    const std::uint32_t limit = device.limits().maxImageDimension2D;
    if (settings.width == 0 || settings.height == 0 || settings.width > limit || settings.height > limit) {
        throw Error(fmt::format("size {}x{}: {} draws 1x1 to {}x{}", settings.width, settings.height,
                                device.info().name, limit, limit));
    }
    if (settings.samples == 0 || settings.samples > kMaxSamples) {
        throw Error(fmt::format("samples must be 1 to {}, not {}", kMaxSamples, settings.samples));
    }
    if (!(std::abs(settings.exposure_ev) <= 64.0f)) {
        throw Error(fmt::format("exposure must be -64 to 64 stops, not {}", settings.exposure_ev));
    }
    check_aov_names(settings.aovs);
}

GpuImage upload_environment(const Device& device, const Environment& environment) {
    const bool map = environment.kind == Environment::Kind::kMap;
    const Image& image = environment.map;
    const vk::Extent2D extent =
        map ? vk::Extent2D{std::uint32_t(image.width), std::uint32_t(image.height)} : vk::Extent2D{1, 1};
    GpuImage result(device, "the environment map", vk::Format::eR32G32B32A32Sfloat, extent, 1,
                    vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst);
    std::vector<glm::vec4> texels(std::size_t(extent.width) * extent.height, glm::vec4(0.0f));
    for (std::size_t i = 0; map && i < texels.size(); ++i) {
        texels[i] = glm::vec4(image.pixels[3 * i], image.pixels[3 * i + 1], image.pixels[3 * i + 2], 1.0f);
    }
    upload(device, result, 0, std::as_bytes(std::span(texels)));
    return result;
}

Image rgb_image(vk::Extent2D extent, const std::vector<std::byte>& data, float scale) {
    Image image(int(extent.width), int(extent.height), 3);
    for (std::size_t i = 0; i < std::size_t(extent.width) * extent.height; ++i) {
        std::array<float, 4> texel;
        std::memcpy(texel.data(), data.data() + i * sizeof(texel), sizeof(texel));
        for (std::size_t c = 0; c < 3; ++c) image.pixels[3 * i + c] = scale * texel[c];
    }
    return image;
}

Image display_image(vk::Extent2D extent, const std::vector<std::byte>& data) {
    Image image(int(extent.width), int(extent.height), 3);
    for (std::size_t i = 0; i < std::size_t(extent.width) * extent.height; ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            image.pixels[3 * i + c] = float(std::to_integer<int>(data[4 * i + c])) / 255.0f;
    }
    return image;
}

}  // namespace

struct Renderer::Impl {
    explicit Impl(const DeviceOptions& options) : device(options), workspace(device), recorder(device) {}

    Device device;
    Workspace workspace;
    Recorder recorder;
    FragmentPool pool;
    vk::Extent2D pool_extent;  // the size that `pool` was measured at
    std::optional<GpuScene> scene;
    std::vector<std::string> scene_warnings;
    std::optional<GpuImage> environment;
    std::optional<Buffer> constants;
    std::optional<Camera> camera;        // set by the caller
    std::optional<Camera> scene_camera;  // the scene's first
    gpu::FrameConstants environment_constants{};

    FrameSettings frame_settings(const RenderSettings& settings, RenderResult& result) const;
    /// Draws a frame, again if need be, until the fragment pool is large enough; returns the pass times.
    std::vector<PassTime> run_frame(const Frame& frame, const FrameSettings& settings,
                                    std::optional<FrameImages>& images);
    /// Sum of the samples' radiance; fills the AOVs, counts and times of `result`.
    const GpuImage& render_samples(const Frame& frame, const FrameSettings& chosen, const RenderSettings& settings,
                                   RenderResult& result);
    void set_constants(const RenderSettings& settings, glm::vec2 jitter);
    Camera camera_for(const RenderSettings& settings) const;
};

Camera Renderer::Impl::camera_for(const RenderSettings& settings) const {
    if (camera) return *camera;
    if (scene_camera) return *scene_camera;
    if (scene->object_count == 0) return Camera{};
    return framing_camera(scene->bounds, settings.width, settings.height, Camera{}.vertical_fov);
}

FrameSettings Renderer::Impl::frame_settings(const RenderSettings& settings, RenderResult& result) const {
    const TechniqueInfo& info = find_technique(settings.technique);
    FrameSettings chosen{technique_of(info), ParameterValues(info, settings.parameters), settings.layer_builder,
                         settings.view};
    if (chosen.layer_builder == LayerBuilder::kSinglePass && !device.fragment_atomics()) {
        chosen.layer_builder = LayerBuilder::kDepthPeeling;
        result.warnings.push_back(
            fmt::format("{} has no fragment-shader atomics: layers are built by depth peeling", device.info().name));
    }
    return chosen;
}

void Renderer::Impl::set_constants(const RenderSettings& settings, glm::vec2 jitter) {
    gpu::FrameConstants values = environment_constants;
    pellucid::set_camera(values, camera_for(settings), settings.width, settings.height, jitter, scene->bounds,
                         scene->refractive_corners);
    values.object_count = scene->object_count;
    std::memcpy(constants->mapped(), &values, sizeof(values));
}

std::vector<PassTime> Renderer::Impl::run_frame(const Frame& frame, const FrameSettings& settings,
                                                std::optional<FrameImages>& images) {
    for (;;) {
        images.emplace(record_frame(recorder, frame, settings, pool));
        std::vector<PassTime> times = recorder.submit_and_wait();
        if (settings.layer_builder != LayerBuilder::kSinglePass || !fragment_pool_overflowed(frame, pool)) return times;
    }
}

const GpuImage& Renderer::Impl::render_samples(const Frame& frame, const FrameSettings& chosen,
                                               const RenderSettings& settings, RenderResult& result) {
    // The frame through pixel centres gives the AOVs and counts; alone, it is the picture too.
    std::optional<FrameImages> images;
    set_constants(settings, {0.0f, 0.0f});
    std::vector<PassTime> times = run_frame(frame, chosen, images);
    read_aovs(device, *images, scene->first_triangles, settings.aovs, result);
    if (settings.samples == 1) {
        result.frames.push_back(std::move(times));
        return images->radiance;
    }
    const GpuImage* sum = nullptr;
    for (std::uint32_t sample = 0; sample < settings.samples; ++sample) {
        set_constants(settings, sample_jitter(sample));
        times = run_frame(frame, chosen, images);
        // Submitted apart: a frame that overflowed was drawn twice, and counts once.
        sum = &accumulate(recorder, frame, images->radiance, sample);
        for (PassTime& time : recorder.submit_and_wait()) times.push_back(std::move(time));
        result.frames.push_back(std::move(times));
    }
    return *sum;
}

Renderer::Renderer(const DeviceOptions& options) : impl_(std::make_unique<Impl>(options)) {
    impl_->constants.emplace(impl_->device, "frame constants", sizeof(gpu::FrameConstants),
                             vk::BufferUsageFlagBits::eStorageBuffer, true);
    set_scene(Scene{});
    set_environment(Environment{});
}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::set_scene(const Scene& scene) {
    check_scene(scene);
    if (!scene.cameras.empty()) check_camera(scene.cameras.front());
    impl_->scene.reset();  // freed first: a large scene may fit once only
    impl_->pool = {};
    try {
        impl_->scene.emplace(impl_->device, scene);
    } catch (...) {
        impl_->scene.emplace(impl_->device, Scene{});
        throw;
    }
    impl_->scene_warnings = approximations(scene);
    impl_->scene_camera = scene.cameras.empty() ? std::nullopt : std::optional(scene.cameras.front());
}

void Renderer::set_environment(const Environment& environment) {
    check_environment(environment);
    impl_->environment = upload_environment(impl_->device, environment);
    gpu::FrameConstants& values = impl_->environment_constants;
    values.environment_kind = std::uint32_t(environment.kind);
    values.environment_uniform = glm::vec4(environment.uniform_radiance, 0.0f);
    const auto coefficients = irradiance_coefficients(environment);
    for (std::size_t i = 0; i < coefficients.size(); ++i) values.irradiance[i] = glm::vec4(coefficients[i], 0.0f);
}

void Renderer::set_camera(const Camera& camera) {
    check_camera(camera);
    impl_->camera = camera;
}

RenderResult Renderer::render(const RenderSettings& settings) {
    Impl& impl = *impl_;
    check_settings(settings, impl.device);
    RenderResult result;
    result.warnings = impl.scene_warnings;
    const FrameSettings chosen = impl.frame_settings(settings, result);
    const Frame frame{
        impl.workspace, *impl.scene, *impl.constants, *impl.environment, {settings.width, settings.height}};
    impl.workspace.trim();
    if (std::exchange(impl.pool_extent, frame.extent) != frame.extent) impl.pool = {};
    try {
        const GpuImage& radiance = impl.render_samples(frame, chosen, settings, result);
        const float mean = 1.0f / float(settings.samples);
        const GpuImage& display =
            tonemap(impl.recorder, frame, radiance, mean * std::exp2(settings.exposure_ev), settings.tonemap);
        impl.recorder.submit_and_wait();
        result.radiance = rgb_image(frame.extent, download(impl.device, radiance, 0), mean);
        result.display = display_image(frame.extent, download(impl.device, display, 0));
    } catch (...) {
        impl.recorder.restart();  // what was recorded may name resources that are gone
        impl.pool = {};
        throw;
    }
    return result;
}

const DeviceInfo& Renderer::device() const { return impl_->device.info(); }
const std::vector<std::string>& Renderer::validation_messages() const { return impl_->device.validation_messages(); }

View parse_view(std::string_view name) {
    return parse_name<View, 2>("view", name, {{{"radiance", View::kRadiance}, {"analysis", View::kAnalysis}}});
}

LayerBuilder parse_layer_builder(std::string_view name) {
    return parse_name<LayerBuilder, 2>(
        "layer builder", name,
        {{{"single-pass", LayerBuilder::kSinglePass}, {"depth-peeling", LayerBuilder::kDepthPeeling}}});
}

ToneMap parse_tonemap(std::string_view name) {
    return parse_name<ToneMap, 4>("tone map", name,
                                  {{{"none", ToneMap::kNone},
                                    {"reinhard", ToneMap::kReinhard},
                                    {"aces", ToneMap::kAces},
                                    {"neutral", ToneMap::kNeutral}}});
}

std::string_view version() { return PELLUCID_VERSION; }

}  // namespace pellucid
