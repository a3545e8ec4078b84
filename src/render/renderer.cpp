#include <pellucid/renderer.h>

#include "render/aovs.h"
#include "render/approximations.h"
#include "render/camera_constants.h"
#include "render/frame.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

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
    std::optional<GpuScene> scene;
    std::vector<std::string> scene_warnings;
    std::optional<GpuImage> environment;
    std::optional<Buffer> constants;
    std::optional<Camera> camera;        // set by the caller
    std::optional<Camera> scene_camera;  // the scene's first
    gpu::FrameConstants environment_constants{};

    FrameSettings frame_settings(const RenderSettings& settings, RenderResult& result) const;
    /// Records frames with `record` until the fragment pool is large enough; returns the pass times.
    template <class Record>
    std::vector<PassTime> run_frame(const Frame& frame, const FrameSettings& settings, Record record);
    void set_constants(const RenderSettings& settings, glm::vec2 jitter);
    Camera camera_for(const RenderSettings& settings) const;
};

Camera Renderer::Impl::camera_for(const RenderSettings& settings) const {
    if (camera) return *camera;
    if (scene_camera) return *scene_camera;
    if (scene->object_count == 0) return Camera{};
    // Fills 70% of the height, or of the width where that is less.
    const float share = 0.7f * std::min(1.0f, float(settings.width) / float(settings.height));
    const float fov = Camera{}.vertical_fov;
    return orbit_camera(scene->bounds, 0.0f, 15.0f, framing_distance(fov, share), fov);
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

template <class Record>
std::vector<PassTime> Renderer::Impl::run_frame(const Frame& frame, const FrameSettings& settings, Record record) {
    for (;;) {
        try {
            record();
        } catch (...) {
            recorder.restart();  // what was recorded may name resources that are gone
            throw;
        }
        std::vector<PassTime> times = recorder.submit_and_wait();
        if (settings.layer_builder != LayerBuilder::kSinglePass || !fragment_pool_overflowed(frame, pool)) return times;
    }
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
    impl_->scene.reset();  // freed first: a large scene may fit once only
    impl_->scene.emplace(impl_->device, scene);
    impl_->scene_warnings = approximations(scene);
    impl_->scene_camera = scene.cameras.empty() ? std::nullopt : std::optional(scene.cameras.front());
}

void Renderer::set_environment(const Environment& environment) {
    impl_->environment.reset();
    impl_->environment.emplace(upload_environment(impl_->device, environment));
    gpu::FrameConstants& values = impl_->environment_constants;
    values.environment_kind = std::uint32_t(environment.kind);
    values.environment_uniform = glm::vec4(environment.uniform_radiance, 0.0f);
    const auto coefficients = irradiance_coefficients(environment);
    for (std::size_t i = 0; i < coefficients.size(); ++i) values.irradiance[i] = glm::vec4(coefficients[i], 0.0f);
}

void Renderer::set_camera(const Camera& camera) { impl_->camera = camera; }

RenderResult Renderer::render(const RenderSettings& settings) {
    Impl& impl = *impl_;
    check_settings(settings, impl.device);
    RenderResult result;
    result.warnings = impl.scene_warnings;
    const FrameSettings chosen = impl.frame_settings(settings, result);
    const Frame frame{
        impl.workspace, *impl.scene, *impl.constants, *impl.environment, {settings.width, settings.height}};
    impl.workspace.trim();

    // The frame through pixel centres gives the AOVs and counts; alone, it is the picture too.
    std::optional<FrameImages> images;
    const GpuImage* radiance = nullptr;
    impl.set_constants(settings, {0.0f, 0.0f});
    std::vector<PassTime> times = impl.run_frame(frame, chosen, [&] {
        images.emplace(record_frame(impl.recorder, frame, chosen, impl.pool));
        radiance = &images->radiance;
    });
    read_aovs(impl.device, *images, impl.scene->first_triangles, settings.aovs, result);
    if (settings.samples == 1) {
        result.frames.push_back(std::move(times));
    } else {
        for (std::uint32_t sample = 0; sample < settings.samples; ++sample) {
            impl.set_constants(settings, sample_jitter(sample));
            result.frames.push_back(impl.run_frame(frame, chosen, [&] {
                const GpuImage& one = record_frame(impl.recorder, frame, chosen, impl.pool).radiance;
                radiance = &accumulate(impl.recorder, frame, one, sample);
            }));
        }
    }
    const float mean = 1.0f / float(settings.samples);
    const GpuImage& display =
        tonemap(impl.recorder, frame, *radiance, mean * std::exp2(settings.exposure_ev), settings.tonemap);
    impl.recorder.submit_and_wait();
    result.radiance = rgb_image(frame.extent, download(impl.device, *radiance, 0), mean);
    result.display = display_image(frame.extent, download(impl.device, display, 0));
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
