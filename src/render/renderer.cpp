#include "gpu/failures.h"
#include "render/approximations.h"
#include "render/check_settings.h"
#include "render/renderer_impl.h"
#include "scene/check_scene.h"
#include "techniques/visibility_layers/visibility_layers.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <utility>

namespace pellucid {
namespace {

double ms_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// LightOptions::caustics; null: photons follow paths.
const Technique* caustics_of(const LightOptions& light, const Device& device) {
    if (light.caustics.empty()) return nullptr;
    const TechniqueInfo& info = find_technique(light.caustics);
    const Technique* technique = technique_of(info);
    if (technique == nullptr) throw Error(fmt::format("caustics: {} is a truth; give a technique", info.name));
    if (const std::string lacking = lacking_for(device, info); !lacking.empty())
        throw DeviceError(fmt::format("{} needs {}, which {} lacks", info.name, lacking, device.info().name));
    return info.whole_scene ? nullptr : technique;
}

/// Stills of more samples gather irradiance at every pixel: their noise is then below the cache's blur.
constexpr std::uint32_t kSamplesOfCache = 32;

/// Photons of every source in every frame.
std::uint32_t photons_of(const FrameSettings& chosen, LightTransport transport) {
    constexpr std::uint32_t kDefault = 16384;
    if (chosen.technique == nullptr || !chosen.parameters.has("photons")) return 0;
    if (chosen.parameters["photons"] >= 0.0) return chosen.parameters.whole("photons");
    return transport == LightTransport::kFull && !chosen.info.volumes ? kDefault : 0;
}

}  // namespace

const GpuImage& Renderer::Impl::filtered_environment_for_scene(Recorder& of) {
    if (scene->rough) {
        if (!filtered_environment) filtered_environment.emplace(device);
        if (!std::exchange(filtered_is_current, true))
            filtered_environment->filter(workspace, of, environment, *environment_map);
        return filtered_environment->filtered;
    }
    if (!no_filtered_environment) no_filtered_environment.emplace(pellucid::no_filtered_environment(device));
    return *no_filtered_environment;
}

Camera Renderer::Impl::camera_for(const RenderSettings& settings) const {
    if (camera) return *camera;
    if (scene_camera) return *scene_camera;
    if (scene->object_count == 0 && cpu.scene().volume_objects.empty()) return Camera{};
    return framing_camera(scene->bounds, settings.width, settings.height, Camera{}.vertical_fov);
}

FrameSettings Renderer::Impl::frame_settings(const RenderSettings& settings, std::vector<std::string>& warnings,
                                             bool recorded) const {
    TechniqueChoice choice = choose(settings.technique, recorded);
    const TechniqueInfo& info = *choice.technique;
    if (const std::string lacking = lacking_for(device, info); !lacking.empty()) {
        throw DeviceError(fmt::format("{} needs {}, which {} lacks", info.name, lacking, device.info().name));
    }
    ParameterMap parameters = settings.parameters;
    parameters.merge(choice.parameters);  // what is there already stays
    FrameSettings chosen{.info = info,
                         .technique = technique_of(info),
                         .truth = truth_of(info),
                         .parameters = ParameterValues(info, parameters),
                         .layer_builder = settings.layer_builder,
                         .view = settings.view};
    check_aov_layers(settings.aovs, chosen.technique ? chosen.technique->layer_count(chosen.parameters) : 1, info.name);
    chosen.caustics = caustics_of(settings.light, device);
    const LightOptions light = chosen_light(settings);
    chosen.photons = photons_of(chosen, light.transport);
    warnings = approximations(cpu.scene(), info, light, chosen.photons > 0);
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

void Renderer::Impl::prepare(const FrameSettings& chosen, const FrameLight& light, const Camera& view,
                             const Progress& progress, std::vector<std::string>& warnings, bool recorded) {
    aim_photons(chosen, light);
    const bool caches = chosen.technique != nullptr && light.bounces > 0 && !scene->opaque.empty();
    irradiance.begin(caches ? scene_brightness(cpu.scene(), scene->bounds, environment_constants) : 0.0f);
    if (chosen.truth) return;
    if (!chosen.info.whole_scene) {
        if (!scene->topology) scene->prepare_topology(device, cpu.scene());
        scene->topology->look_from(device, cpu.scene(), view);
        for (std::string& line : unknown_solids(*scene->topology, chosen.info)) warnings.push_back(std::move(line));
    }
    // Shapes that a deforming mesh passes through are not worth a file each.
    bake::BakeCache passing{std::filesystem::path()};
    bake::BakeCache& cache = scene->moves > 0 ? passing : bake_cache;
    const Preparation preparation{device, cpu.scene(), *scene, cache, options.threads, progress, warnings, recorded};
    if (photons.any() || irradiance.any() || (!chosen.info.whole_scene && light.any() && !scene->opaque.empty()))
        prepare_light(preparation);
    if (chosen.technique->prepare != nullptr) chosen.technique->prepare(preparation, chosen.parameters);
    if (photons.any() && chosen.caustics != nullptr && chosen.caustics->prepare != nullptr)
        chosen.caustics->prepare(preparation, ParameterValues(chosen.caustics->info, {}));
    if (scene->topology) scene->topology->look_from(device, cpu.scene(), view);
}

void Renderer::Impl::aim_photons(const FrameSettings& chosen, const FrameLight& light) {
    const bool by_paths = chosen.caustics == nullptr;
    PhotonSources sources{.lights = light.lights > 0, .emitters = light.emitters > 0 && by_paths};
    if (light.bounces > 0 && by_paths && chosen.photons > 0) sources.environment = shares_of_environment();
    // Tinted shadows have the light that glass lets through.
    PhotonSetup setup = photon_setup(cpu.scene(), scene->bounds, sources, light.tinted_shadows ? 0 : chosen.photons);
    setup.by = chosen.caustics;
    setup.layer_builder = chosen.layer_builder;
    setup.draw_opaque = draw_opaque;
    photons.begin(std::move(setup));
}

const EnvironmentShares* Renderer::Impl::shares_of_environment() {
    if (!environment_shares) environment_shares.emplace(tabulate_environment(device, environment));
    return *environment_shares ? &**environment_shares : nullptr;
}

gpu::FrameConstants Renderer::Impl::constants_of(const Frame& frame, const RenderSettings& settings,
                                                 std::optional<std::uint32_t> sample, std::uint32_t part) const {
    gpu::FrameConstants values = environment_constants;
    const glm::vec2 jitter = jitter_of(settings, sample);
    pellucid::set_camera(values, camera_for(settings), settings.width, settings.height, jitter, scene->bounds,
                         scene->refractive_corners);
    set_tile(values, frame.first, frame.extent);
    values.object_count = scene->object_count;
    values.sample_index = settings.first_sample + sample.value_or(0);
    values.light_part = part;
    values.occlusion = frame.light.bounces == 0 ? 1 : 0;
    return values;
}

LightOptions Renderer::Impl::chosen_light(const RenderSettings& settings) const {
    LightOptions light = settings.light;
    if (light.transport != LightTransport::kAutomatic) return light;
    constexpr std::uint32_t kEnough = 8;  // samples; with fewer, the noise of bounces is worse than what they bring
    const bool several = settings.still && (settings.samples >= kEnough || settings.error > 0.0f);
    light.transport = scene->light_count + scene->emitter_count == 0 ? LightTransport::kEnvironment
                      : several                                      ? LightTransport::kFull
                                                                     : LightTransport::kDirect;
    return light;
}

FrameLight Renderer::Impl::frame_light(const LightOptions& wanted) const {
    if (wanted.transport == LightTransport::kEnvironment) return {};
    const std::vector<Light>& lights = cpu.scene().lights;
    return {.lights = scene->light_count,
            .emitters = scene->emitter_count,
            .visible = std::any_of(lights.begin(), lights.end(), has_size),
            .tinted_shadows = wanted.shadows == Shadows::kTinted,
            .bounces = wanted.transport == LightTransport::kFull ? wanted.bounces : 0};
}

Frame Renderer::Impl::frame_of(Recorder& of, const RenderSettings& settings) {
    return {workspace,
            *scene,
            *constants,
            environment_constants,
            *environment_map,
            filtered_environment_for_scene(of),
            std::uint32_t(environment.kind),
            {settings.width, settings.height},
            glm::uvec2(0),
            1,
            frame_light(chosen_light(settings)),
            background_radiance,
            background_depth};
}

Frame Renderer::Impl::lit_frame(Recorder& of, const RenderSettings& settings) {
    Frame frame = frame_of(of, settings);
    frame.photons = photons.bindings();
    frame.irradiance = irradiance.bindings();
    if (const auto* shares = frame.light.bounces > 0 ? shares_of_environment() : nullptr)
        frame.environment_shares = &shares->buffer;
    frame.bounces_before_cache =
        settings.still && (settings.samples > kSamplesOfCache || settings.error > 0.0f) ? 1 : 0;
    frame.light.photons_of_emitters = photons.of_emitters();
    frame.light.photons_of_environment = photons.of_environment();
    if (settings.view == View::kWavefront) frame.front_exposure = std::exp2(settings.exposure_ev);
    return frame;
}

void Renderer::Impl::require_no_frames() const {
    if (unread_frames > 0) throw Error(fmt::format("{} frames have not been read (vulkan::Frames)", unread_frames));
}

void Renderer::Impl::forget_frame() {
    recorder.restart();  // what was recorded may name resources that are gone
    layer_source = LayerSource();
    workspace.clear();
}

Renderer::Renderer(const DeviceOptions& options) try : impl_(std::make_unique<Impl>(options, options)) {
    begin();
} catch (const vk::SystemError& failure) {
    throw_clearly(failure);
}

Renderer::Renderer(const vulkan::LentDevice& device, std::uint32_t threads) try
    : impl_(std::make_unique<Impl>(device, DeviceOptions{.device = name_of(device), .threads = threads})) {
    begin();
} catch (const vk::SystemError& failure) {
    throw_clearly(failure);
}

void Renderer::begin() {
    impl_->constants.emplace(impl_->device, "frame constants", sizeof(gpu::FrameConstants),
                             vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst);
    set_scene(Scene{});
    set_environment(Environment{});
}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::set_scene(const Scene& scene) try {
    impl_->require_no_frames();
    check_scene(scene);
    ++impl_->changes;
    if (!scene.cameras.empty()) check_camera(scene.cameras.front());
    Scene copy = scene;
    impl_->scene = GpuScene(impl_->device, Scene{});  // frees the old one: a large scene may fit once only
    impl_->layer_source = LayerSource();
    impl_->solid_lighting.forget();
    impl_->photons.forget();
    impl_->irradiance.forget();
    impl_->cpu.set_scene(Scene{});
    impl_->scene_camera.reset();
    impl_->scene = GpuScene(impl_->device, scene);
    impl_->cpu.set_scene(std::move(copy));
    impl_->scene_camera = scene.cameras.empty() ? std::nullopt : std::optional(scene.cameras.front());
} catch (const vk::SystemError& failure) {
    throw_clearly(failure);
}

void Renderer::set_positions(const std::vector<MovedMesh>& moved) try {
    impl_->begin_change();
    impl_->cpu.set_positions(moved);  // checks them, and changes nothing if they are wrong
    std::vector<int> meshes;
    for (const MovedMesh& each : moved) meshes.push_back(each.mesh);
    impl_->scene->move_vertices(impl_->device, impl_->cpu.scene(), meshes);
} catch (const vk::SystemError& failure) {
    throw_clearly(failure);
}

void Renderer::set_transforms(const std::vector<PosedObject>& moved) try {
    impl_->begin_change();
    impl_->cpu.set_transforms(moved);
    std::vector<int> objects;
    for (const PosedObject& each : moved) objects.push_back(each.object);
    impl_->scene->move_objects(impl_->device, impl_->cpu.scene(), objects);
} catch (const vk::SystemError& failure) {
    throw_clearly(failure);
}

void Renderer::set_material(int index, const Material& material) try {
    impl_->begin_change();
    const auto number = std::size_t(index);
    const auto& materials = impl_->cpu.scene().materials;
    const bool was_refractive = number < materials.size() && materials[number].refractive();
    impl_->cpu.set_material(index, material);
    impl_->scene->set_material(impl_->device, impl_->cpu.scene(), number, was_refractive);
} catch (const vk::SystemError& failure) {
    throw_clearly(failure);
}

void Renderer::set_light(int index, const Light& light) {
    std::vector<Light> lights = impl_->cpu.scene().lights;
    if (index < 0 || std::size_t(index) >= lights.size())
        throw Error(fmt::format("there is no light {}; the scene has {}", index, lights.size()));
    lights[std::size_t(index)] = light;
    set_lights(lights);
}

void Renderer::set_lights(const std::vector<Light>& lights) try {
    impl_->begin_change();
    check_lights(lights);
    impl_->cpu.set_lights(lights);
    impl_->scene->set_lights(impl_->device, lights);
} catch (const vk::SystemError& failure) {
    throw_clearly(failure);
}

void Renderer::set_environment(const Environment& environment) try {
    impl_->begin_change();
    check_environment(environment);
    impl_->filtered_is_current = false;
    impl_->photons.begin({});
    impl_->environment_shares.reset();
    impl_->environment_map = upload_environment(impl_->device, environment);
    impl_->environment = environment;
    pellucid::set_environment(impl_->environment_constants, environment);
} catch (const vk::SystemError& failure) {
    throw_clearly(failure);
}

void Renderer::turn_environment(float rotation, float intensity) {
    impl_->begin_change();
    Environment turned;
    turned.rotation = rotation;
    turned.intensity = intensity;
    check_environment(turned);
    impl_->filtered_is_current = false;
    impl_->photons.begin({});
    impl_->environment_shares.reset();
    impl_->environment.rotation = rotation;
    impl_->environment.intensity = intensity;
    pellucid::set_environment(impl_->environment_constants, impl_->environment);
}

void Renderer::set_camera(const Camera& camera) {
    impl_->begin_change();
    check_camera(camera);
    impl_->camera = camera;
    ++impl_->camera_changes;
}

RenderResult Renderer::render(const RenderSettings& settings) try {
    Impl& impl = *impl_;
    check_settings(settings, impl.device);
    impl.require_no_frames();
    RenderResult result;
    const FrameSettings chosen = impl.frame_settings(settings, result.warnings);
    try {
        impl.prepare(chosen, impl.frame_light(impl.chosen_light(settings)), impl.camera_for(settings),
                     settings.progress, result.warnings);
        result.light = impl.chosen_light(settings).transport;
        impl.light_solids(settings.thickness, impl.all_lights(), settings.progress, result.warnings);
        const bool filtered = impl.filtered_is_current;
        Frame frame = impl.lit_frame(impl.recorder, settings);
        if (filtered != impl.filtered_is_current)
            impl.recorder.submit_and_wait();  // apart from frames, which may be forgotten
        impl.workspace.trim();
        if (std::exchange(impl.layer_extent, frame.extent) != frame.extent) impl.layer_source.forget_size();
        const Impl::Drawn drawn = impl.draw_tiles(frame, chosen, settings, result);
        warn_of(result, chosen, drawn.cut, settings);
        impl.irradiance.report(result.warnings);
        result.photon_flux = impl.photons.flux();
        const bool draws = draws_picture(chosen);
        if (!draws) impl.trace_image(chosen, settings, result);
        if (chosen.technique && chosen.technique->report) chosen.technique->report(*impl.scene, result.warnings);
        const bool summed = draws && settings.error <= 0.0f;  // otherwise it is a mean already
        const float scale = summed ? float(1.0 / double(settings.samples)) : 1.0f;
        result.display = display_picture(impl.recorder, frame, drawn.tiles, {result.radiance, drawn.on_device, scale},
                                         impl.adaptation, settings);
        if (settings.tonemap == ToneMap::kKrawczyk) result.adapted_cd_m2 = impl.adaptation.adapted_cd_m2();
        for (float& value : result.radiance.pixels) value *= scale;
        for (auto& [name, image] : result.aovs) {
            if (draws && is_light_part(name))
                for (float& value : image.pixels) value *= scale;
        }
    } catch (...) {
        impl.recorder.restart();  // what was recorded may name resources that are gone
        impl.filtered_is_current = false;
        impl.layer_source = LayerSource();
        impl.solid_lighting.forget();
        impl.photons.forget();
        impl.irradiance.forget();
        throw;
    }
    ++impl.changes;  // frames have another workspace now
    return result;
} catch (const vk::SystemError& failure) {
    throw_clearly(failure);
}

ThicknessResult Renderer::measure_thickness(const ThicknessRequest& request) try {
    Impl& impl = *impl_;
    RenderSettings settings;
    settings.width = request.width;
    settings.height = request.height;
    settings.thickness = request.settings;
    check_settings(settings, impl.device);
    impl.require_no_frames();
    if (request.light >= impl.cpu.scene().lights.size()) {
        throw Error(
            fmt::format("there is no light {}; the scene has {}", request.light, impl.cpu.scene().lights.size()));
    }
    ThicknessResult result;
    TransmittedLight& transmitted = impl.solid_lighting.transmitted();
    try {
        impl.light_solids(request.settings, {request.light}, request.progress, result.warnings);
        const bool filtered = impl.filtered_is_current;
        Frame frame = impl.frame_of(impl.recorder, settings);
        if (filtered != impl.filtered_is_current) impl.recorder.submit_and_wait();
        Impl::begin_frame(impl.recorder, frame, impl.constants_of(frame, settings, std::nullopt));
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
        impl.filtered_is_current = false;
        impl.solid_lighting.forget();
        impl.photons.forget();
        impl.irradiance.forget();
        throw;
    }
    result.cut_rays = transmitted.cut_rays();
    result.light_views = transmitted.view_count();
    return result;
} catch (const vk::SystemError& failure) {
    throw_clearly(failure);
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
