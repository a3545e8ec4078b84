#pragma once

// What a Renderer holds, and how it draws a picture: tile by tile, sample by sample, frame by frame.
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

/// Whether frames make the image, or a truth traces its own.
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
    vk::Extent2D layer_extent;  // the size that `layer_source` has learnt from
    std::optional<GpuScene> scene;
    Environment environment;
    std::optional<GpuImage> environment_map;
    std::optional<FilteredEnvironment> filtered_environment;             // made once a scene needs it
    bool filtered_is_current = false;                                    // it is of `environment`
    std::optional<GpuImage> no_filtered_environment;                     // for scenes that do not
    std::optional<std::optional<EnvironmentShares>> environment_shares;  // once photons need them; none: it is black
    std::optional<Buffer> constants;
    std::optional<Camera> camera;        // set by the caller
    std::optional<Camera> scene_camera;  // the scene's first
    gpu::FrameConstants environment_constants{};
    const GpuImage* background_radiance = nullptr;  // Frame::background_radiance of the frame to come
    const GpuImage* background_depth = nullptr;
    std::uint64_t camera_changes = 0;     ///< how many of `changes` are the camera's
    std::uint64_t changes = 0;            ///< how often what was set has changed
    std::function<void()> before_change;  ///< of what the host may be tracing; of vulkan::Frames
    /// Before a function of the caller's changes what frames look at.
    void begin_change() {
        if (before_change) before_change();
        ++changes;
    }
    bool has_frames = false;          ///< a vulkan::Frames exists
    std::uint32_t unread_frames = 0;  ///< of vulkan::Frames

    struct Drawn {
        std::vector<Tile> tiles;
        const GpuImage* on_device = nullptr;  ///< radiance of the only tile
        bool cut = false;                     ///< glass lies in several tiles, or beside opaque surfaces of others
    };

    /// `recorded`, here and below: for frames that are recorded into commands of the caller's.
    TechniqueChoice choose(std::string_view name, bool recorded = false) const {
        const auto times = [&](auto techniques) { return measured_times(device.info(), options, techniques); };
        return choose_technique(name, device, !cpu.scene().volume_objects.empty(), times, recorded);
    }
    FrameSettings frame_settings(const RenderSettings& settings, std::vector<std::string>& warnings,
                                 bool recorded = false) const;
    /// Lets the technique compute what it wants of the scene; ParameterValues of `chosen` say what.
    void prepare(const FrameSettings& chosen, const FrameLight& light, const Camera& view, const Progress& progress,
                 std::vector<std::string>& warnings, bool recorded = false);
    /// Draws one sample of every pixel, again if need be until the fragment pool is large enough; returns
    /// the pass times. `progress` is of this sample.
    /// `sample`: none for the frame through the centres of the pixels.
    std::vector<PassTime> run_frame(Frame& frame, const FrameSettings& chosen, const RenderSettings& settings,
                                    std::optional<std::uint32_t> sample, const Progress& progress,
                                    std::optional<FrameImages>& images);
    /// Draws a sample of every pixel, of those that want one; counts and times go to `part`. Returns its radiance.
    const GpuImage& draw_sample(Frame& frame, const FrameSettings& chosen, const RenderSettings& settings,
                                std::uint32_t sample, const Progress& progress, RenderResult& part);
    /// Records a frame until what it gathers fits, and waits for it. Adds its times to `times`.
    FrameImages draw_until_fits(const Frame& frame, const FrameSettings& chosen, const TracedView* traced,
                                std::vector<PassTime>& times);
    /// Draws the frame that run_frame() drew last again, once for every part of its light that `settings` ask for, and adds
    /// each to its sum. Returns the sums, by the parts' names.
    std::map<std::string, const GpuImage*> draw_parts(Frame& frame, const FrameSettings& chosen,
                                                      const RenderSettings& settings,
                                                      std::optional<std::uint32_t> sample, const GpuImage* wanted);
    /// Draws samples of a tile that tell how many each of its pixels needs.
    std::vector<std::uint32_t> samples_for(Frame& frame, const FrameSettings& chosen, const RenderSettings& settings,
                                           const Progress& progress, RenderResult& part);
    /// Draws the samples of a tile; fills the radiance (the sum of the samples), AOVs, paths, counts and times of `part`.
    /// Returns the radiance on the device; null where a truth traces the image.
    const GpuImage* render_samples(Frame& frame, const FrameSettings& chosen, const RenderSettings& settings,
                                   RenderResult& part);
    /// Draws all tiles; they are smaller in the end than at first where one did not fit the device.
    Drawn draw_tiles(Frame frame, const FrameSettings& chosen, const RenderSettings& settings, RenderResult& result);
    /// `sample`: none for the frame through the centres of the pixels.
    TracedView traced_view(const RenderSettings& settings, std::optional<std::uint32_t> sample,
                           const Progress& progress);
    /// The image that a truth traces itself.
    void trace_image(const FrameSettings& chosen, const RenderSettings& settings, RenderResult& result);
    /// `of`: records what it has to make first.
    Frame frame_of(Recorder& of, const RenderSettings& settings);
    /// A frame with all that its light needs; prepare() comes before.
    Frame lit_frame(Recorder& of, const RenderSettings& settings);
    /// Settings::light with what kAutomatic stands for.
    LightOptions chosen_light(const RenderSettings& settings) const;
    FrameLight frame_light(const LightOptions& wanted) const;
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
    /// Sends photons and gathers irradiance for a frame, and waits until both are there. Adds its times to `times`.
    void light_frame(const Frame& frame, bool first, std::vector<PassTime>& times);
    /// For a picture of a technique whose parameter `photons` asks for some of every light.
    void aim_photons(const FrameSettings& chosen, const FrameLight& light);
    const EnvironmentShares* shares_of_environment();
    /// `part`: PELLUCID_ALL_LIGHT, or the only part of the light that the frame draws.
    gpu::FrameConstants constants_of(const Frame& frame, const RenderSettings& settings,
                                     std::optional<std::uint32_t> sample,
                                     std::uint32_t part = PELLUCID_ALL_LIGHT) const;
    /// Begins to record `frame` as `view` sees it, after what has been set since the last one.
    static void begin_frame(Recorder& recorder, Frame& frame, const gpu::FrameConstants& view) {
        recorder.upload_pending();
        frame.view = view;
        recorder.write(frame.constants, view);
    }
    /// Throws Error if frames have not been read.
    void require_no_frames() const;
    Camera camera_for(const RenderSettings& settings) const;
    /// Where in the pixel a sample lies, from its centre, pixels; none: at the centre.
    static glm::vec2 jitter_of(const RenderSettings& settings, std::optional<std::uint32_t> sample) {
        return sample ? sample_jitter(settings.first_sample + *sample) : glm::vec2(0.0f);
    }
    const GpuImage& filtered_environment_for_scene(Recorder& of);
};

}  // namespace pellucid
