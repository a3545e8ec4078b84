#pragma once

// State of a Renderer, and how it draws an image: tile by tile, sample by sample, frame by frame.
#include "gpu/camera_constants.h"
#include "gpu/environment_images.h"
#include "gpu/environment_shares.h"
#include "render/aovs.h"
#include "render/cpu_tracing.h"
#include "render/display.h"
#include "render/frame.h"
#include "render/measured_techniques.h"
#include "render/photon_lighting.h"
#include "render/solid_lighting.h"
#include "render/tiles.h"

#include <pellucid/renderer.h>

#include <numeric>
#include <optional>

namespace pellucid {

/// True if frames draw the image, false if a reference technique traces its own.
inline bool draws_picture(const FrameSettings& chosen) {
    return chosen.truth == nullptr || chosen.truth->trace_image == nullptr || chosen.view == View::kAnalysis;
}

struct Renderer::Impl {
    template <class Given>
    Impl(const Given& of_device, const DeviceOptions& given)
        : device(of_device), workspace(device), recorder(device), cpu(given.threads), options(given),
          solid_lighting(device), photons(device), irradiance(device), adaptation(device) {}

    Device device;
    Workspace workspace;
    Recorder recorder;
    CpuTracing cpu;
    const DeviceOptions options;
    bake::BakeCache bake_cache;
    SolidLighting solid_lighting;
    Photons photons;
    IrradianceCache irradiance;
    Adaptation adaptation;
    LayerSource layer_source;
    vk::Extent2D layer_extent;  // extent that `layer_source` has learnt from
    std::optional<GpuScene> scene;
    Environment environment;
    std::optional<GpuImage> environment_map;
    std::optional<FilteredEnvironment> filtered_environment;  // created once a scene needs it
    bool filtered_is_current = false;                         // whether it belongs to `environment`
    std::optional<GpuImage> no_filtered_environment;          // for scenes that need none
    // created once photons need them; inner empty: the environment is black
    std::optional<std::optional<EnvironmentShares>> environment_shares;
    std::optional<Buffer> constants;
    std::optional<Camera> camera;        // camera set by the caller
    std::optional<Camera> scene_camera;  // the scene's first camera
    gpu::FrameConstants environment_constants{};
    const GpuImage* background_radiance = nullptr;  // Frame::background_radiance of the next frame
    const GpuImage* background_depth = nullptr;
    std::uint64_t camera_changes = 0;  ///< changes of the camera among `changes`
    std::uint64_t changes = 0;         ///< number of changes by setters
    /// called before changes to data that the host may be tracing; set by vulkan::Frames
    std::function<void()> before_change;
    /// Call before a setter changes data that frames use.
    void begin_change() {
        if (before_change) before_change();
        ++changes;
    }
    bool has_frames = false;          ///< a vulkan::Frames exists
    std::uint32_t unread_frames = 0;  ///< unread tickets of vulkan::Frames

    struct Drawn {
        std::vector<Tile> tiles;
        const GpuImage* on_device = nullptr;  ///< radiance of a single tile
        bool cut = false;  ///< several tiles contain glass, or glass and opaque surfaces lie in different tiles
    };

    /// `recorded`, here and below: for frames recorded into the caller's commands.
    TechniqueChoice choose(std::string_view name, bool recorded = false) const {
        const auto times = [&](auto techniques) { return measured_times(device.info(), options, techniques); };
        return choose_technique(name, device, !cpu.scene().volume_objects.empty(), times, recorded);
    }
    FrameSettings frame_settings(const RenderSettings& settings, std::vector<std::string>& warnings,
                                 bool recorded = false) const;
    /// Prepares the technique's data for the scene, according to `chosen.parameters`.
    void prepare(const FrameSettings& chosen, const FrameLight& light, const Camera& view, const Progress& progress,
                 std::vector<std::string>& warnings, bool recorded = false);
    /// Draws one sample of every pixel, and repeats it until the fragment pool is large enough. Returns the pass
    /// times. `progress`: of this sample. `sample`: empty for the frame through pixel centres.
    std::vector<PassTime> run_frame(Frame& frame, const FrameSettings& chosen, const RenderSettings& settings,
                                    std::optional<std::uint32_t> sample, const Progress& progress,
                                    std::optional<FrameImages>& images);
    /// Draws a sample of every pixel that needs one. Adds counts and times to `part`. Returns the radiance.
    const GpuImage& draw_sample(Frame& frame, const FrameSettings& chosen, const RenderSettings& settings,
                                std::uint32_t sample, const Progress& progress, RenderResult& part);
    /// Records a frame and waits for it, until its buffers fit. Adds its times to `times`.
    FrameImages draw_until_fits(const Frame& frame, const FrameSettings& chosen, const TracedView* traced,
                                std::vector<PassTime>& times);
    /// Repeats the last frame of run_frame(), once for every part of its light that `settings` request, and adds each
    /// to its sum. Returns the sums by the parts' names.
    std::map<std::string, const GpuImage*> draw_parts(Frame& frame, const FrameSettings& chosen,
                                                      const RenderSettings& settings,
                                                      std::optional<std::uint32_t> sample, const GpuImage* wanted);
    /// Draws pilot samples of a tile. Returns the samples that each of its pixels needs.
    std::vector<std::uint32_t> samples_for(Frame& frame, const FrameSettings& chosen, const RenderSettings& settings,
                                           const Progress& progress, RenderResult& part);
    /// Draws the samples of a tile. Fills the radiance (the sum of the samples), AOVs, paths, counts and times of
    /// `part`. Returns the radiance on the device; null if a reference technique traces the image.
    const GpuImage* render_samples(Frame& frame, const FrameSettings& chosen, const RenderSettings& settings,
                                   RenderResult& part);
    /// Draws all tiles. Halves the remaining tiles if one does not fit the device.
    Drawn draw_tiles(Frame frame, const FrameSettings& chosen, const RenderSettings& settings, RenderResult& result);
    /// `sample`: empty for the frame through pixel centres.
    TracedView traced_view(const RenderSettings& settings, std::optional<std::uint32_t> sample,
                           const Progress& progress);
    /// Traces the image of a reference technique that has its own.
    void trace_image(const FrameSettings& chosen, const RenderSettings& settings, RenderResult& result);
    /// Creates a frame. `of`: recorder for the resources that must be created first.
    Frame frame_of(Recorder& of, const RenderSettings& settings);
    /// Creates a frame with all data for its light. Call prepare() first.
    Frame lit_frame(Recorder& of, const RenderSettings& settings);
    /// Settings::light with kAutomatic resolved.
    LightOptions chosen_light(const RenderSettings& settings) const;
    FrameLight frame_light(const LightOptions& wanted) const;
    /// Discards the state of a failed frame. Capacities are learnt anew.
    void forget_frame();
    std::vector<std::uint32_t> all_lights() const {
        std::vector<std::uint32_t> numbers(cpu.scene().lights.size());
        std::iota(numbers.begin(), numbers.end(), 0u);
        return numbers;
    }
    /// Prepares an image whose translucent objects are lit by `lights`.
    void light_solids(const ThicknessSettings& settings, const std::vector<std::uint32_t>& lights,
                      const Progress& progress, std::vector<std::string>& warnings) {
        bake::BakeCache passing{std::filesystem::path()};  // without a folder, as in prepare()
        solid_lighting.begin(settings, lights, cpu.scene(), *scene, scene->moves > 0 ? passing : bake_cache,
                             options.threads, progress, warnings);
    }
    /// Sends photons and gathers irradiance for a frame, and waits for both. Adds the times to `times`.
    void light_frame(const Frame& frame, bool first, std::vector<PassTime>& times);
    /// Prepares photons for an image by a technique with a parameter `photons`.
    void aim_photons(const FrameSettings& chosen, const FrameLight& light);
    const EnvironmentShares* shares_of_environment();
    /// `part`: PELLUCID_ALL_LIGHT, or the single part of the light that the frame draws.
    gpu::FrameConstants constants_of(const Frame& frame, const RenderSettings& settings,
                                     std::optional<std::uint32_t> sample,
                                     std::uint32_t part = PELLUCID_ALL_LIGHT) const;
    /// Begins to record `frame` for `view`, after uploading pending changes.
    static void begin_frame(Recorder& recorder, Frame& frame, const gpu::FrameConstants& view) {
        recorder.upload_pending();
        frame.view = view;
        recorder.write(frame.constants, view);
    }
    /// Throws Error if frames are unread.
    void require_no_frames() const;
    Camera camera_for(const RenderSettings& settings) const;
    /// Offset of a sample from its pixel's centre, pixels; 0 without a sample.
    static glm::vec2 jitter_of(const RenderSettings& settings, std::optional<std::uint32_t> sample) {
        return sample ? sample_jitter(settings.first_sample + *sample) : glm::vec2(0.0f);
    }
    const GpuImage& filtered_environment_for_scene(Recorder& of);
};

}  // namespace pellucid
