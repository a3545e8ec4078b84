#pragma once

#include <pellucid/animation.h>
#include <pellucid/api.h>
#include <pellucid/device.h>
#include <pellucid/display.h>
#include <pellucid/environment.h>
#include <pellucid/image.h>
#include <pellucid/layer_builder.h>
#include <pellucid/light_options.h>
#include <pellucid/photon_flux.h>
#include <pellucid/progress.h>
#include <pellucid/reference.h>
#include <pellucid/refracted_path.h>
#include <pellucid/scene.h>
#include <pellucid/technique.h>
#include <pellucid/thickness.h>

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

namespace vulkan {
struct LentDevice;
class Frames;
}  // namespace vulkan

struct RenderSettings {
    std::uint32_t width = 512;  ///< pixels, >= 1
    std::uint32_t height = 512;
    std::string technique = "balanced";  ///< name of a technique or a preset
    ParameterMap parameters;             ///< parameters of the technique; they override those of a preset
    LayerBuilder layer_builder = LayerBuilder::kAutomatic;
    View view = View::kRadiance;
    /// Jittered frames, averaged in linear light. A single sample, and every AOV, uses pixel centres.
    std::uint32_t samples = 1;
    /// Index of the first sample, 0 to 2^20. Images with other indices have other random numbers. Samples 0 to 7 and 8
    /// to 15 average to an image of 16, unless a cache learns between samples.
    std::uint32_t first_sample = 0;
    /// Above 0: adaptive sampling. Each pixel takes samples until its standard error is at most this share of its
    /// luminance plus middle grey (0.18 at exposure 0), `most_samples` at most. `samples` is ignored. 8 pilot samples
    /// per pixel estimate the error; they are not part of the image, which stays unbiased.
    float error = 0.0f;
    std::uint32_t most_samples = 256;
    /// False: each sample is a frame of a sequence and costs as much as an image of one sample; for timing. True: a
    /// technique may spend more on each sample of a still.
    bool still = true;
    LightOptions light;
    ThicknessSettings thickness;  ///< thickness of translucent objects that lights shine through
    ToneMap tonemap = ToneMap::kNeutral;
    float exposure_ev = 0.0f;  ///< stops; radiance is multiplied by 2^exposure_ev, for kKrawczyk after adaptation
    /// kKrawczyk: luminance of radiance 1, cd/m2, 1e-6 to 1e9. By default, the white of the other curves has the
    /// luminance of a display's white. Set 1 if radiance is in cd/m2, as for glTF's lights.
    float unit_luminance_cd_m2 = 100.0f;
    /// kKrawczyk: seconds since the renderer's last image with this tone map, >= 0. The eye adapts to the new image
    /// for this time. Infinite: the eye is fully adapted, as for the first image.
    float adaptation_s = std::numeric_limits<float>::infinity();
    std::vector<std::string> aovs;  ///< names from aov_infos() to return in RenderResult::aovs
    bool paths = false;             ///< fill RenderResult::paths
    bool photon_flux = false;       ///< fill RenderResult::photon_flux
    /// Most pixels of a tile; 0: as many as the device can allocate. A larger image is drawn tile by tile and is the
    /// same, except for rounding and the warnings of a technique's tiles (docs/architecture.md, Tiles).
    std::uint64_t tile_pixels = 0;
    Progress progress;
};

/// An image of a quantity other than colour. Values are taken at pixel centres.
struct AovInfo {
    std::string_view name;
    int channels;
    std::string_view doc;
};
PELLUCID_API std::span<const AovInfo> aov_infos();

struct RenderResult {
    Image radiance;  ///< RGB, scene-linear, before exposure; other views return their colours here
    Image display;   ///< RGB, 0..1, tone mapped and sRGB-encoded
    std::map<std::string, Image, std::less<>> aovs;
    std::vector<RefractedPath> paths;  ///< if requested: one per pixel, through its centre, rows from the top
    Image standard_error;              ///< RGB, of `radiance`, if the technique estimates it (path); else empty
    Image sample_counts;     ///< 1 channel: samples of every pixel, if RenderSettings::error chose them; else empty
    PhotonFlux photon_flux;  ///< flux of the first frame, if requested
    std::uint64_t cut_paths = 0;  ///< technique `path`: paths cut at the length limit
    float adapted_cd_m2 = 0.0f;   ///< tone map kKrawczyk: luminance to which the eye has adapted; else 0
    /// One entry per sample; empty if the device has no timestamps. On the software driver, the first frame of a size
    /// includes shader compilation.
    std::vector<std::vector<PassTime>> frames;
    /// light transport of the frames; reference techniques include all light
    LightTransport light = LightTransport::kEnvironment;
    std::uint32_t layer_passes = 0;                    ///< geometry passes that built the last frame's layers
    std::uint64_t cut_rays = 0;                        ///< ThicknessResult::cut_rays of the first frame, all lights
    std::uint64_t covered = 0;                         ///< pixels whose first surface is refracting glass
    std::array<std::uint64_t, kStatusCount> status{};  ///< covered pixels by Status
    std::uint64_t side_conflicts = 0;   ///< covered pixels where shading and geometric normal disagreed about the side
    std::vector<std::string> warnings;  ///< differences between the scene and its image; one line each
};

/// Draws scenes on one Vulkan device. Needs no window. Not thread safe; any number of renderers may exist.
class PELLUCID_API Renderer {
public:
    explicit Renderer(const DeviceOptions& options = {});
    /// Draws on a device of the caller's (pellucid/vulkan.h). Throws DeviceError naming the missing features if the
    /// device was created without them. `threads`: as DeviceOptions::threads.
    explicit Renderer(const vulkan::LentDevice& device, std::uint32_t threads = 0);
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    /// Uploads the scene and copies it for techniques that trace on the CPU; `scene` may be destroyed afterwards.
    /// Throws Error if the device runs out of memory.
    void set_scene(const Scene& scene);
    /// Moves vertices of the scene's meshes in every object that uses them; the next render() draws them. Positions
    /// and unit normals are in the mesh's own frame, one per vertex, and are copied. Throws Error and moves nothing if
    /// a mesh does not exist, a count differs or a number is not finite.
    ///
    /// The cost is one upload of these vertices (24 bytes each) and one pass over the scene's vertices for its bounds.
    /// Layers are rebuilt in every frame anyway. Ray tracing techniques update their hierarchies at the next use.
    /// Techniques that bake (TechniqueInfo::bakes) bake again if glass has moved. If the device fails meanwhile, the
    /// shape is undefined until the next call. A camera that was not set keeps framing the scene.
    void set_positions(const std::vector<MovedMesh>& moved);
    /// Moves objects of the scene. Recomputes the precedence of overlapping solids, and baked values. Throws Error and
    /// moves nothing if an object does not exist or a placement is not affine and invertible.
    void set_transforms(const std::vector<PosedObject>& moved);
    /// Replaces a material of Scene::materials. The new material must have the same textures. Throws Error and changes
    /// nothing if the new material is not allowed, or the index does not exist.
    void set_material(int index, const Material& material);
    /// Replaces a light. Throws Error and changes nothing if the light does not exist or a value is out of range.
    void set_light(int index, const Light& light);
    /// Replaces all lights of the scene. Throws Error and changes nothing if a value is out of range.
    void set_lights(const std::vector<Light>& lights);
    void set_environment(const Environment& environment);
    /// Rotates and scales the current environment (Environment::rotation and intensity).
    void turn_environment(float rotation, float intensity);
    /// Default: the scene's first camera, or else a camera that frames the scene: azimuth 0, elevation 15 degrees,
    /// field of view 30 degrees. The bounding sphere then fills 70% of the height.
    void set_camera(const Camera& camera);

    /// Renders the scene; without set_scene(), no objects in the studio environment. Throws Error for settings out of
    /// range, unknown names, or images beyond this machine's memory. Throws DeviceError for a technique that the
    /// device does not support.
    RenderResult render(const RenderSettings& settings);
    /// Thickness of solid between a light and each visible point of a translucent surface, at pixel centres, as
    /// render() computes it. Throws Error for settings out of range, or if the light does not exist.
    ThicknessResult measure_thickness(const ThicknessRequest& request);
    /// Throws the errors that render() would throw at once for these settings.
    void check(const RenderSettings& settings) const;

    /// The exact tracer of the current scene, built on first use. Valid until the next set_scene() or set_positions().
    const Tracer& tracer();

    const DeviceInfo& device() const;
    /// The technique that a name selects on this device and for the current scene: volumes need a technique that draws
    /// them. Throws Error listing the known techniques and presets.
    TechniqueChoice choose(std::string_view name) const;
    /// Features that a technique needs and the device lacks, worded to follow "needs"; empty: the technique is usable.
    std::string lacking(const TechniqueInfo& technique) const;
    /// Messages of the validation layer since the renderer was created.
    const std::vector<std::string>& validation_messages() const;

private:
    friend class vulkan::Frames;
    void begin();

    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The version of the library, "0.1.0".
PELLUCID_API std::string_view version();

}  // namespace pellucid
