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
    std::string technique = "balanced";  ///< or a preset
    ParameterMap parameters;             ///< of the technique; they go before those of a preset
    LayerBuilder layer_builder = LayerBuilder::kAutomatic;
    View view = View::kRadiance;
    /// Jittered frames, averaged in linear light. 1 samples pixel centres. AOVs always do.
    std::uint32_t samples = 1;
    /// Number of the first sample, 0 to 2^20: pictures of other samples have other random numbers, so those of samples 0 to 7
    /// and 8 to 15 average to one of 16 but for what caches learn from sample to sample.
    std::uint32_t first_sample = 0;
    /// Above 0: each pixel takes as many samples as its standard error needs to be this small at most, as a share of its
    /// luminance and middle grey (0.18 at an exposure of 0), but `most_samples`; `samples` goes unused. 8 samples of every
    /// pixel are drawn first to tell, and are no part of the picture, which stays unbiased.
    float error = 0.0f;
    std::uint32_t most_samples = 256;
    /// False: the samples stand for frames that follow each other, each drawn with what a picture of one sample would
    /// spend; for timing. A technique may do more for each sample of a still.
    bool still = true;
    LightOptions light;
    ThicknessSettings thickness;  ///< of translucent objects that lights shine through
    ToneMap tonemap = ToneMap::kNeutral;
    float exposure_ev = 0.0f;  ///< stops; radiance is multiplied by 2^exposure_ev; kKrawczyk: on top of what adapts
    /// kKrawczyk: luminance of radiance 1, cd/m2, 1e-6 to 1e9. By default what other curves show as white has that of a
    /// display's white. 1 where radiance is in cd/m2, as of glTF's lights.
    float unit_luminance_cd_m2 = 100.0f;
    /// kKrawczyk: seconds since the renderer's last picture with this tone map, >= 0: the eye adapts to the new one by
    /// as much. Infinite: altogether, as to the first.
    float adaptation_s = std::numeric_limits<float>::infinity();
    std::vector<std::string> aovs;  ///< names of aov_infos() wanted in RenderResult::aovs
    bool paths = false;             ///< fill RenderResult::paths
    bool photon_flux = false;       ///< fill RenderResult::photon_flux
    /// Pixels of a tile, at most; 0: as many as the device holds. A picture of more is drawn tile by tile and is the same
    /// picture, but for what the tiles of a technique warn of and for rounding (docs/architecture.md, Tiles).
    std::uint64_t tile_pixels = 0;
    Progress progress;
};

/// An image of something other than colour. Values are taken at pixel centres.
struct AovInfo {
    std::string_view name;
    int channels;
    std::string_view doc;
};
PELLUCID_API std::span<const AovInfo> aov_infos();

struct RenderResult {
    Image radiance;  ///< RGB, scene-linear, before exposure; the colours of other views in these
    Image display;   ///< RGB, 0..1, tone mapped and sRGB-encoded
    std::map<std::string, Image, std::less<>> aovs;
    std::vector<RefractedPath> paths;  ///< if asked for: one per pixel, through its centre, rows from the top
    Image standard_error;              ///< RGB, of `radiance`, where the technique estimates it (path); else empty
    Image sample_counts;     ///< 1 channel: samples of every pixel, where RenderSettings::error chose them; else empty
    PhotonFlux photon_flux;  ///< of the first frame, if asked for
    std::uint64_t cut_paths = 0;  ///< technique path: paths that reached its limit of length
    float adapted_cd_m2 = 0.0f;   ///< tone map kKrawczyk: the luminance that the eye has adapted to; else 0
    /// One entry per sample; empty where the device has no timestamps. On the software driver the
    /// first frame of a size includes compiling the shaders.
    std::vector<std::vector<PassTime>> frames;
    LightTransport light = LightTransport::kEnvironment;  ///< of its frames; truths follow all light
    std::uint32_t layer_passes = 0;                       ///< geometry passes that built the last frame's layers
    std::uint64_t cut_rays = 0;                           ///< ThicknessResult::cut_rays of the first frame, all lights
    std::uint64_t covered = 0;                            ///< pixels whose first surface is refracting glass
    std::array<std::uint64_t, kStatusCount> status{};     ///< covered pixels by Status
    std::uint64_t side_conflicts = 0;   ///< covered pixels where shading and geometric normal disagreed about the side
    std::vector<std::string> warnings;  ///< what of the scene is drawn otherwise than it is; one line each
};

/// Draws scenes on one Vulkan device. Needs no window. Not thread safe; any number may exist.
class PELLUCID_API Renderer {
public:
    explicit Renderer(const DeviceOptions& options = {});
    /// On a device of the caller's (pellucid/vulkan.h). Throws DeviceError, naming what is missing, if the device was not made
    /// with what Pellucid needs. `threads`: as DeviceOptions::threads.
    explicit Renderer(const vulkan::LentDevice& device, std::uint32_t threads = 0);
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    /// Uploads, and keeps a copy for techniques that trace on the CPU; `scene` may go afterwards. Throws
    /// Error if the device cannot hold it.
    void set_scene(const Scene& scene);
    /// Moves vertices of meshes of the scene that was set, in every object that shows them; the next render() draws
    /// them. Positions and normals (unit) are in the mesh's own frame, as many as it has, and are copied. Throws
    /// Error, and moves nothing, if a mesh does not exist, a count differs or a number is not finite.
    ///
    /// Costs one upload of these vertices (24 bytes each) and one pass over the scene's for its bounds. Layers are
    /// drawn anew in every frame anyway; hierarchies of techniques that trace rays are brought up to date when one
    /// of them is next asked for, and techniques that bake (TechniqueInfo::bakes) do so again if glass has moved. If
    /// the device fails in between, the shape is undefined until the next call. A camera that was not set keeps framing what there is.
    void set_positions(const std::vector<MovedMesh>& moved);
    /// Moves objects of the scene that was set. Throws Error, and moves nothing, if there is no such object or a placement is
    /// not affine and invertible. Which solid displaces which is found anew, and what techniques bake.
    void set_transforms(const std::vector<PosedObject>& moved);
    /// Replaces one of Scene::materials; its textures must be those that it has. Throws Error, and changes nothing, if it
    /// must not, or if there is no such material.
    void set_material(int index, const Material& material);
    /// Replaces one of the lights. Throws Error, and changes nothing, if there is no such light or it is out of range.
    void set_light(int index, const Light& light);
    /// The lights from now on, in place of the scene's. Throws Error, and changes nothing, if one is out of range.
    void set_lights(const std::vector<Light>& lights);
    void set_environment(const Environment& environment);
    /// Turns and scales the environment that was set (Environment::rotation and intensity).
    void turn_environment(float rotation, float intensity);
    /// Default: the scene's first camera, or one that frames the scene (azimuth 0, elevation 15
    /// degrees, 30 degrees of field, the bounding sphere filling 70% of the height).
    void set_camera(const Camera& camera);

    /// Renders what was set; before that there are no objects and the studio environment. Throws Error for
    /// settings out of range, unknown names, or pictures beyond this machine's memory, DeviceError for a technique that
    /// the device does not offer.
    RenderResult render(const RenderSettings& settings);
    /// The length of solid between a light and each visible point of a translucent surface, through pixel centres, as
    /// render() finds it. Throws Error for settings out of range, or if there is no such light.
    ThicknessResult measure_thickness(const ThicknessRequest& request);
    /// Throws what render() would throw at once for these settings.
    void check(const RenderSettings& settings) const;

    /// The exact tracer of the scene that was set, built on first use; valid until the next
    /// set_scene() or set_positions().
    const Tracer& tracer();

    const DeviceInfo& device() const;
    /// What a name stands for on this device and for the scene that was set: volumes need a technique that draws them. Throws Error listing the known names, of techniques and presets.
    TechniqueChoice choose(std::string_view name) const;
    /// What the device lacks for a technique, in words that follow "needs"; empty: it can be used.
    std::string lacking(const TechniqueInfo& technique) const;
    /// What the validation layer has said since the renderer was made.
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
