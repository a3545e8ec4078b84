#include <pellucid/renderer.h>

#include "gpu/environment_images.h"
#include "render/adaptive_sampling.h"
#include "render/aovs.h"
#include "render/approximations.h"
#include "render/camera_constants.h"
#include "render/check_settings.h"
#include "render/cpu_tracing.h"
#include "render/display.h"
#include "render/frame.h"
#include "render/measured_techniques.h"
#include "render/solid_lighting.h"
#include "render/tiles.h"
#include "scene/check_scene.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numeric>
#include <optional>
#include <utility>

namespace pellucid {
namespace {

double ms_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// Adds what an earlier attempt at the frame did and this one need not do again, as building a hierarchy.
std::vector<PassTime> with_missing_passes(std::vector<PassTime> times, const std::vector<PassTime>& earlier) {
    for (const PassTime& pass : earlier) {
        const bool repeated =
            std::any_of(times.begin(), times.end(), [&](const PassTime& time) { return time.name == pass.name; });
        if (!repeated) times.push_back(pass);
    }
    return times;
}

constexpr double kPilotShare = 0.1;  ///< of the progress that is shown

Image image_of(const std::vector<std::uint32_t>& counts, vk::Extent2D extent) {
    Image image(int(extent.width), int(extent.height), 1);
    std::transform(counts.begin(), counts.end(), image.pixels.begin(),
                   [](std::uint32_t count) { return float(count); });
    return image;
}

const GpuImage& upload_counts(const Frame& frame, const std::vector<std::uint32_t>& counts) {
    const GpuImage& image = frame.workspace.image("wanted samples", vk::Format::eR32Uint, frame.extent);
    upload(frame.workspace.device(), image, 0, std::as_bytes(std::span(counts)));
    return image;
}

/// Whether frames make the image, or a truth traces its own.
bool draws_picture(const FrameSettings& chosen) {
    return chosen.truth == nullptr || chosen.truth->trace_image == nullptr || chosen.view == View::kAnalysis;
}

}  // namespace

struct Renderer::Impl {
    explicit Impl(const DeviceOptions& given)
        : device(given), workspace(device), recorder(device), cpu(given.threads), options(given),
          solid_lighting(device), adaptation(device) {}

    Device device;
    Workspace workspace;
    Recorder recorder;
    CpuTracing cpu;
    const DeviceOptions options;
    bake::BakeCache bake_cache;
    SolidLighting solid_lighting;
    Adaptation adaptation;
    LayerSource layer_source;
    vk::Extent2D layer_extent;  // the size that `layer_source` has learnt from
    std::optional<GpuScene> scene;
    Environment environment;
    std::optional<GpuImage> environment_map;
    std::optional<GpuImage> filtered_environment;     // of `environment`; made once a scene needs it
    std::optional<GpuImage> no_filtered_environment;  // for scenes that do not
    std::optional<Buffer> constants;
    std::optional<Camera> camera;        // set by the caller
    std::optional<Camera> scene_camera;  // the scene's first
    gpu::FrameConstants environment_constants{};

    struct Drawn {
        std::vector<Tile> tiles;
        const GpuImage* on_device = nullptr;  ///< radiance of the only tile
        bool cut = false;                     ///< glass lies in several tiles, or beside opaque surfaces of others
    };

    TechniqueChoice choose(std::string_view name) const {
        const auto times = [&](auto techniques) { return measured_times(device.info(), options, techniques); };
        return choose_technique(name, device, !cpu.scene().volume_objects.empty(), times);
    }
    FrameSettings frame_settings(const RenderSettings& settings, std::vector<std::string>& warnings) const;
    /// Lets the technique compute what it wants of the scene; ParameterValues of `chosen` say what.
    void prepare(const FrameSettings& chosen, const Camera& view, const Progress& progress,
                 std::vector<std::string>& warnings);
    /// Draws one sample of every pixel, again if need be until the fragment pool is large enough; returns
    /// the pass times. `progress` is of this sample.
    /// `sample`: none for the frame through the centres of the pixels.
    std::vector<PassTime> run_frame(const Frame& frame, const FrameSettings& chosen, const RenderSettings& settings,
                                    std::optional<std::uint32_t> sample, const Progress& progress,
                                    std::optional<FrameImages>& images);
    /// Draws a sample of every pixel, of those that want one; counts and times go to `part`. Returns its radiance.
    const GpuImage& draw_sample(const Frame& frame, const FrameSettings& chosen, const RenderSettings& settings,
                                std::uint32_t sample, const Progress& progress, RenderResult& part);
    /// Draws samples of a tile that tell how many each of its pixels needs.
    std::vector<std::uint32_t> samples_for(const Frame& frame, const FrameSettings& chosen,
                                           const RenderSettings& settings, const Progress& progress,
                                           RenderResult& part);
    /// Draws the samples of a tile; fills the radiance (the sum of the samples), AOVs, paths, counts and times of `part`.
    /// Returns the radiance on the device; null where a truth traces the image.
    const GpuImage* render_samples(const Frame& frame, const FrameSettings& chosen, const RenderSettings& settings,
                                   RenderResult& part);
    /// Draws all tiles; they are smaller in the end than at first where one did not fit the device.
    Drawn draw_tiles(Frame frame, const FrameSettings& chosen, const RenderSettings& settings, RenderResult& result);
    TracedView traced_view(const RenderSettings& settings, glm::vec2 jitter_px, const Progress& progress);
    /// The image that a truth traces itself.
    void trace_image(const FrameSettings& chosen, const RenderSettings& settings, RenderResult& result);
    Frame frame_of(const RenderSettings& settings);
    /// Takes back what a frame that failed has left. Rooms for what frames need are learnt anew.
    void forget_frame();
    std::vector<std::uint32_t> all_lights() const {
        std::vector<std::uint32_t> numbers(cpu.scene().lights.size());
        std::iota(numbers.begin(), numbers.end(), 0u);
        return numbers;
    }
    /// For pictures that `lights` shine through translucent objects of.
    void light_solids(const ThicknessSettings& settings, const std::vector<std::uint32_t>& lights,
                      const Progress& progress, std::vector<std::string>& warnings) {
        bake::BakeCache passing{std::filesystem::path()};  // as in prepare()
        solid_lighting.begin(settings, lights, cpu.scene(), *scene, scene->moves > 0 ? passing : bake_cache,
                             options.threads, progress, warnings);
    }
    gpu::FrameConstants current_constants() const {
        gpu::FrameConstants values{};
        std::memcpy(&values, constants->mapped(), sizeof(values));
        return values;
    }
    void set_constants(const Frame& frame, const RenderSettings& settings, glm::vec2 jitter, std::uint32_t sample);
    Camera camera_for(const RenderSettings& settings) const;
    const GpuImage& filtered_environment_for_scene();
};

const GpuImage& Renderer::Impl::filtered_environment_for_scene() {
    if (filtered_environment) return *filtered_environment;
    if (scene->rough)
        return filtered_environment.emplace(filter_environment(workspace, recorder, environment, *environment_map));
    if (!no_filtered_environment) no_filtered_environment.emplace(pellucid::no_filtered_environment(device));
    return *no_filtered_environment;
}

Camera Renderer::Impl::camera_for(const RenderSettings& settings) const {
    if (camera) return *camera;
    if (scene_camera) return *scene_camera;
    if (scene->object_count == 0 && cpu.scene().volume_objects.empty()) return Camera{};
    return framing_camera(scene->bounds, settings.width, settings.height, Camera{}.vertical_fov);
}

FrameSettings Renderer::Impl::frame_settings(const RenderSettings& settings, std::vector<std::string>& warnings) const {
    TechniqueChoice choice = choose(settings.technique);
    const TechniqueInfo& info = *choice.technique;
    if (const std::string lacking = lacking_for(device, info); !lacking.empty()) {
        throw DeviceError(fmt::format("{} needs {}, which {} lacks", info.name, lacking, device.info().name));
    }
    warnings = approximations(cpu.scene(), info);
    ParameterMap parameters = settings.parameters;
    parameters.merge(choice.parameters);  // what is there already stays
    FrameSettings chosen{.info = info,
                         .technique = technique_of(info),
                         .truth = truth_of(info),
                         .parameters = ParameterValues(info, parameters),
                         .layer_builder = settings.layer_builder,
                         .view = settings.view};
    if (settings.view == View::kWavefront) {
        if (chosen.truth || chosen.technique->draw_light == nullptr)
            throw Error(fmt::format("view wavefront: {} traces no wavefronts of light; ihrke-2007 does", info.name));
        if (cpu.scene().lights.empty()) throw Error("view wavefront: the scene has no lights");
    }
    if (chosen.layer_builder == LayerBuilder::kAutomatic)
        chosen.layer_builder = device.is_cpu() ? LayerBuilder::kCompute : LayerBuilder::kSinglePass;
    if (chosen.layer_builder == LayerBuilder::kSinglePass && !device.fragment_atomics()) {
        chosen.layer_builder = LayerBuilder::kDepthPeeling;
        warnings.push_back(
            fmt::format("{} has no fragment-shader atomics: layers are built by depth peeling", device.info().name));
    }
    if (chosen.layer_builder == LayerBuilder::kDualDepthPeeling && !device.float_blending()) {
        chosen.layer_builder = LayerBuilder::kDepthPeeling;
        warnings.push_back(fmt::format("{} does not blend 32-bit floats: layers are built by depth peeling one by one",
                                       device.info().name));
    }
    return chosen;
}

void Renderer::Impl::prepare(const FrameSettings& chosen, const Camera& view, const Progress& progress,
                             std::vector<std::string>& warnings) {
    if (chosen.truth) return;
    if (!chosen.info.whole_scene) {
        if (!scene->topology) scene->prepare_topology(device, cpu.scene());
        scene->topology->look_from(device, cpu.scene(), view);
        for (std::string& line : unknown_solids(*scene->topology, chosen.info)) warnings.push_back(std::move(line));
    }
    if (chosen.technique->prepare == nullptr) return;
    // Shapes that a deforming mesh passes through are not worth a file each.
    bake::BakeCache passing{std::filesystem::path()};
    bake::BakeCache& cache = scene->moves > 0 ? passing : bake_cache;
    chosen.technique->prepare({device, cpu.scene(), *scene, cache, options.threads, progress, warnings},
                              chosen.parameters);
    if (scene->topology) scene->topology->look_from(device, cpu.scene(), view);
}

void Renderer::Impl::set_constants(const Frame& frame, const RenderSettings& settings, glm::vec2 jitter,
                                   std::uint32_t sample) {
    gpu::FrameConstants values = environment_constants;
    pellucid::set_camera(values, camera_for(settings), settings.width, settings.height, jitter, scene->bounds,
                         scene->refractive_corners);
    set_tile(values, frame.first, frame.extent);
    values.object_count = scene->object_count;
    values.sample_index = sample;
    std::memcpy(constants->mapped(), &values, sizeof(values));
}

std::vector<PassTime> Renderer::Impl::run_frame(const Frame& frame, const FrameSettings& chosen,
                                                const RenderSettings& settings, std::optional<std::uint32_t> sample,
                                                const Progress& progress, std::optional<FrameImages>& images) {
    const glm::vec2 jitter = sample ? sample_jitter(*sample) : glm::vec2(0.0f);
    set_constants(frame, settings, jitter, sample.value_or(0));
    std::optional<TracedView> traced;
    if (chosen.truth) traced.emplace(traced_view(settings, jitter, progress));
    std::vector<PassTime> times;
    for (;;) {
        TransmittedLight& transmitted = solid_lighting.transmitted();
        images.emplace(record_frame(recorder, frame, chosen, layer_source, transmitted, traced ? &*traced : nullptr));
        times = with_missing_passes(recorder.submit_and_wait(), times);
        const bool light_again = transmitted.must_repeat(frame);
        if (!layer_source.must_repeat(frame) && !light_again) return times;
    }
}

const GpuImage& Renderer::Impl::draw_sample(const Frame& frame, const FrameSettings& chosen,
                                            const RenderSettings& settings, std::uint32_t sample,
                                            const Progress& progress, RenderResult& part) {
    std::optional<FrameImages> images;
    part.frames.push_back(run_frame(frame, chosen, settings, sample, progress, images));
    part.layer_passes = layer_source.geometry_passes();
    return images->radiance;
}

std::vector<std::uint32_t> Renderer::Impl::samples_for(const Frame& frame, const FrameSettings& chosen,
                                                       const RenderSettings& settings, const Progress& progress,
                                                       RenderResult& part) {
    PixelNoise noise;
    for (std::uint32_t i = 0; i < kPilotSamples; ++i) {
        // Numbers that no sample of the picture has.
        const Progress of_sample = part_of(progress, double(i) / kPilotSamples, double(i + 1) / kPilotSamples);
        noise.add(
            download_rgb(device, draw_sample(frame, chosen, settings, settings.most_samples + i, of_sample, part)));
    }
    return noise.samples_for(settings.error, settings.exposure_ev, settings.most_samples);
}

const GpuImage* Renderer::Impl::render_samples(const Frame& frame, const FrameSettings& chosen,
                                               const RenderSettings& settings, RenderResult& part) {
    const bool draws = draws_picture(chosen);
    // The frame through pixel centres gives the AOVs and counts; alone, it is the picture too.
    std::optional<FrameImages> images;
    const bool adaptive = settings.error > 0.0f;
    const bool alone = draws && settings.samples == 1 && !adaptive;
    std::vector<PassTime> times =
        run_frame(frame, chosen, settings, std::nullopt, alone ? settings.progress : Progress(), images);
    read_back(device, *images, current_constants(), scene->first_triangles, settings, part);
    part.layer_passes = layer_source.geometry_passes();
    part.cut_rays = solid_lighting.transmitted().cut_rays();
    if (!draws) return nullptr;
    const GpuImage* sum = &images->radiance;
    if (alone) {
        part.frames.push_back(std::move(times));
        part.radiance = download_rgb(device, *sum);
        return sum;
    }
    Frame sampled = frame;
    if (settings.still) sampled.samples = adaptive ? settings.most_samples : settings.samples;
    std::uint32_t samples = settings.samples;
    const GpuImage* wanted = nullptr;
    const double before = adaptive ? kPilotShare : 0.0;
    if (adaptive) {
        const auto counts = samples_for(sampled, chosen, settings, part_of(settings.progress, 0.0, before), part);
        samples = *std::max_element(counts.begin(), counts.end());
        part.sample_counts = image_of(counts, frame.extent);
        wanted = &upload_counts(frame, counts);
    }
    for (std::uint32_t sample = 0; sample < samples; ++sample) {
        const auto share = [&](std::uint32_t done) { return before + (1.0 - before) * done / samples; };
        const Progress progress = part_of(settings.progress, share(sample), share(sample + 1));
        if (wanted != nullptr && (chosen.truth || !chosen.technique->searches_layers))
            sampled.wanted_samples.emplace(WantedSamples{*wanted, sample});
        const GpuImage& radiance = draw_sample(sampled, chosen, settings, sample, progress, part);
        // Submitted apart: a frame that overflowed was drawn twice, and counts once.
        sum = &accumulate(recorder, frame, radiance, sample, wanted);
        for (PassTime& time : recorder.submit_and_wait()) part.frames.back().push_back(std::move(time));
        if (progress) progress(1.0);
    }
    part.radiance = download_rgb(device, *sum);
    return sum;
}

Renderer::Impl::Drawn Renderer::Impl::draw_tiles(Frame frame, const FrameSettings& chosen,
                                                 const RenderSettings& settings, RenderResult& result) {
    const glm::uvec2 size(settings.width, settings.height);
    // Paths have 16 bytes per pixel in one buffer; other techniques list the pixels with glass.
    std::uint64_t most = most_tile_pixels(device, chosen.info.whole_scene ? 16 : 4);
    if (settings.tile_pixels > 0) most = std::min<std::uint64_t>(most, settings.tile_pixels);
    set_constants(frame, settings, glm::vec2(0.0f), 0);
    const std::optional<Tile> glass = tile_of_glass(current_constants(), scene->refractive_corners);
    std::vector<Tile> left = tiles_of(size, glass, most, device);
    TileProgress progress(settings.progress, size);
    Drawn drawn;
    while (!left.empty()) {
        const Tile tile = left.back();
        frame.first = tile.first;
        frame.extent = tile.extent();
        RenderSettings of_tile = settings;
        if (progress && draws_picture(chosen)) of_tile.progress = [&](double done) { progress.show(tile, done); };
        RenderResult part;
        try {
            drawn.on_device = render_samples(frame, chosen, of_tile, part);
        } catch (const TooLarge&) {
            if (!halve(left)) throw;
            forget_frame();
            continue;
        }
        left.pop_back();
        add_tile(result, std::move(part), tile, size);
        drawn.tiles.push_back(tile);
        if (draws_picture(chosen) && tile.size != size) progress.show(tile, 1.0);
        progress.finish(tile);
    }
    if (drawn.tiles.size() == 1) return drawn;
    drawn.on_device = nullptr;
    drawn.cut = !glass || !scene->opaque.empty() ||
                std::none_of(drawn.tiles.begin(), drawn.tiles.end(), [&](const Tile& t) { return t.holds(*glass); });
    return drawn;
}

TracedView Renderer::Impl::traced_view(const RenderSettings& settings, glm::vec2 jitter_px, const Progress& progress) {
    return {cpu.tracer(), camera_for(settings), {settings.width, settings.height}, jitter_px, progress};
}

void Renderer::Impl::trace_image(const FrameSettings& chosen, const RenderSettings& settings, RenderResult& result) {
    const auto trace = [&](const PictureSamples& samples, const Progress& progress) {
        return chosen.truth->trace_image(traced_view(settings, glm::vec2(0.0f), progress), environment, samples,
                                         chosen.parameters);
    };
    PictureSamples samples{.count = settings.samples};
    const double before = settings.error > 0.0f ? kPilotShare : 0.0;
    if (settings.error > 0.0f) {
        const PathTracedImage pilot =
            trace({.count = kPilotSamples, .first = settings.most_samples}, part_of(settings.progress, 0.0, before));
        samples.of_pixels = PixelNoise(pilot.radiance, pilot.standard_error, kPilotSamples)
                                .samples_for(settings.error, settings.exposure_ev, settings.most_samples);
        result.sample_counts = image_of(samples.of_pixels, {settings.width, settings.height});
    }
    PathTracedImage traced = trace(samples, part_of(settings.progress, before, 1.0));
    result.radiance = std::move(traced.radiance);
    result.standard_error = std::move(traced.standard_error);
    result.cut_paths = traced.cut_paths;
}

Frame Renderer::Impl::frame_of(const RenderSettings& settings) {
    return {workspace,
            *scene,
            *constants,
            *environment_map,
            filtered_environment_for_scene(),
            std::uint32_t(environment.kind),
            {settings.width, settings.height}};
}

void Renderer::Impl::forget_frame() {
    recorder.restart();  // what was recorded may name resources that are gone
    layer_source = LayerSource();
    for (int i = 0; i < 2; ++i) workspace.trim();  // the first marks everything as unused
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
    Scene copy = scene;
    impl_->scene.reset();  // freed first: a large scene may fit once only
    impl_->layer_source = LayerSource();
    impl_->solid_lighting.forget();
    impl_->cpu.set_scene(Scene{});
    impl_->scene_camera.reset();
    try {
        impl_->scene.emplace(impl_->device, scene);
    } catch (...) {
        impl_->scene.emplace(impl_->device, Scene{});
        throw;
    }
    impl_->cpu.set_scene(std::move(copy));
    impl_->scene_camera = scene.cameras.empty() ? std::nullopt : std::optional(scene.cameras.front());
}

void Renderer::set_positions(const std::vector<MovedMesh>& moved) {
    impl_->cpu.set_positions(moved);  // checks them, and changes nothing if they are wrong
    std::vector<int> meshes;
    for (const MovedMesh& each : moved) meshes.push_back(each.mesh);
    impl_->scene->move_vertices(impl_->device, impl_->cpu.scene(), meshes);
}

void Renderer::set_lights(const std::vector<Light>& lights) {
    check_lights(lights);
    impl_->cpu.set_lights(lights);
}

void Renderer::set_environment(const Environment& environment) {
    check_environment(environment);
    impl_->filtered_environment.reset();
    impl_->environment_map = upload_environment(impl_->device, environment);
    impl_->environment = environment;
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
    const FrameSettings chosen = impl.frame_settings(settings, result.warnings);
    impl.prepare(chosen, impl.camera_for(settings), settings.progress, result.warnings);
    impl.light_solids(settings.thickness, impl.all_lights(), settings.progress, result.warnings);
    Frame frame = impl.frame_of(settings);
    if (settings.view == View::kWavefront) frame.front_exposure = std::exp2(settings.exposure_ev);
    impl.workspace.trim();
    if (std::exchange(impl.layer_extent, frame.extent) != frame.extent) impl.layer_source.forget_size();
    try {
        const Impl::Drawn drawn = impl.draw_tiles(frame, chosen, settings, result);
        warn_of(result, chosen, drawn.cut, settings);
        const bool draws = draws_picture(chosen);
        if (!draws) impl.trace_image(chosen, settings, result);
        if (chosen.technique && chosen.technique->report) chosen.technique->report(*impl.scene, result.warnings);
        const bool summed = draws && settings.error <= 0.0f;  // otherwise it is a mean already
        const float scale = summed ? float(1.0 / double(settings.samples)) : 1.0f;
        result.display = display_picture(impl.recorder, frame, drawn.tiles, {result.radiance, drawn.on_device, scale},
                                         impl.adaptation, settings);
        if (settings.tonemap == ToneMap::kKrawczyk) result.adapted_cd_m2 = impl.adaptation.adapted_cd_m2();
        for (float& value : result.radiance.pixels) value *= scale;
    } catch (...) {
        impl.recorder.restart();  // what was recorded may name resources that are gone
        impl.layer_source = LayerSource();
        impl.solid_lighting.forget();
        throw;
    }
    return result;
}

ThicknessResult Renderer::measure_thickness(const ThicknessRequest& request) {
    Impl& impl = *impl_;
    RenderSettings settings;
    settings.width = request.width;
    settings.height = request.height;
    settings.thickness = request.settings;
    check_settings(settings, impl.device);
    if (request.light >= impl.cpu.scene().lights.size()) {
        throw Error(
            fmt::format("there is no light {}; the scene has {}", request.light, impl.cpu.scene().lights.size()));
    }
    ThicknessResult result;
    impl.light_solids(request.settings, {request.light}, request.progress, result.warnings);
    const Frame frame = impl.frame_of(settings);
    impl.set_constants(frame, settings, glm::vec2(0.0f), 0);
    TransmittedLight& transmitted = impl.solid_lighting.transmitted();
    try {
        const GpuImage* thickness = nullptr;
        do {
            const auto start = std::chrono::steady_clock::now();
            const Opaque opaque = draw_opaque(impl.recorder, frame);
            thickness = &transmitted.measure(impl.recorder, frame, opaque);
            impl.recorder.submit_and_wait();
            result.wall_ms = ms_since(start);
        } while (transmitted.must_repeat(frame));
        result.geometry_passes = transmitted.geometry_passes();
        if (request.time_maps) {
            const Opaque opaque = draw_opaque(impl.recorder, frame);
            impl.recorder.submit_and_wait();
            const auto start = std::chrono::steady_clock::now();
            transmitted.build_maps(impl.recorder, frame, opaque);
            impl.recorder.submit_and_wait();
            result.map_ms = ms_since(start);
        }
        result.thickness = Image(int(settings.width), int(settings.height), 1);
        const std::vector<std::byte> texels = download(impl.device, *thickness, 0);
        std::memcpy(result.thickness.pixels.data(), texels.data(), texels.size());
    } catch (...) {
        impl.recorder.restart();  // what was recorded may name resources that are gone
        impl.solid_lighting.forget();
        throw;
    }
    result.cut_rays = transmitted.cut_rays();
    result.light_views = transmitted.view_count();
    return result;
}

const Tracer& Renderer::tracer() { return impl_->cpu.tracer(); }
void Renderer::check(const RenderSettings& settings) const {
    check_settings(settings, impl_->device);
    std::vector<std::string> warnings;
    impl_->frame_settings(settings, warnings);
}
const DeviceInfo& Renderer::device() const { return impl_->device.info(); }
TechniqueChoice Renderer::choose(std::string_view name) const { return impl_->choose(name); }

std::string Renderer::lacking(const TechniqueInfo& technique) const {
    return lacking_for(impl_->device, find_technique(technique.name));
}
const std::vector<std::string>& Renderer::validation_messages() const { return impl_->device.validation_messages(); }

std::string_view version() { return PELLUCID_VERSION; }

}  // namespace pellucid
