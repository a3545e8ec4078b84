#pragma once

#include "gpu/binding.h"
#include "gpu/gpu_scene.h"
#include "gpu/structs.h"
#include "gpu/workspace.h"

#include <optional>
#include <vector>

namespace pellucid {

/// How many samples every pixel gets, where that differs from pixel to pixel.
struct WantedSamples {
    const GpuImage& counts;    ///< R32UI, of the tile
    std::uint32_t sample = 0;  ///< that this frame draws, from 0: pixels that want no more need not be drawn
};

/// The light that a frame follows to opaque surfaces, beyond that of an environment which nothing hides.
struct FrameLight {
    std::uint32_t lights = 0;             ///< of GpuScene::lights; 0: none is followed
    std::uint32_t emitters = 0;           ///< of GpuScene::emitters, likewise
    bool visible = false;                 ///< some of them have a size, and are seen
    bool tinted_shadows = false;          ///< glass lets the straight ray pass, weakened, instead of blocking it
    std::uint32_t bounces = 0;            ///< reflections that rays follow, 0 to 7, before the cache has the rest
    bool photons_of_emitters = false;     ///< Frame::photons has what glass and metal make of their light,
    bool photons_of_environment = false;  ///< and of the environment's

    bool any() const { return lights > 0 || emitters > 0 || bounces > 0; }
    std::uint32_t visible_lights() const { return visible ? lights : 0; }
};

/// What every pass of a frame may look at.
struct Frame {
    Workspace& workspace;
    const GpuScene& scene;
    const Buffer& constants;               ///< one gpu::FrameConstants, bound as "Frame"
    gpu::FrameConstants view;              ///< what `constants` holds when the frame runs
    const GpuImage& environment;           ///< map, or one texel if the environment is a formula
    const GpuImage& filtered_environment;  ///< see gpu/environment_images.h; what stands in for it if !scene.rough
    std::uint32_t environment_kind;        ///< pellucid::Environment::Kind
    vk::Extent2D extent;                   ///< of the tile that is drawn
    glm::uvec2 first{0};                   ///< its first pixel in the picture
    std::uint32_t samples = 1;             ///< of the picture that this frame is one of
    FrameLight light = {};
    const GpuImage* background_radiance = nullptr;  ///< RGBA32F: what the caller has drawn; null: nothing
    const GpuImage* background_depth = nullptr;     ///< R32F, m along the view's axis; PELLUCID_EMPTY_DEPTH: a sky
    std::optional<WantedSamples> wanted_samples = std::nullopt;
    std::uint32_t sample = 0;                       ///< of Frame::samples, which this frame is
    const std::vector<Binding>* photons = nullptr;  ///< for look-ups (light/photon_store.h); null: there are none
    const Buffer* environment_shares =
        nullptr;  ///< gpu/environment_shares.h, where surfaces look for what hides it; null: none do
    const std::vector<Binding>* irradiance = nullptr;    ///< of a cache, for look-ups; null: there is none
    std::uint32_t bounces_before_cache = 0;              ///< that paths follow before the cache stands for the rest
    bool recorded = false;                               ///< into commands of the caller's: the host has no part in it
    std::optional<float> front_exposure = std::nullopt;  ///< View::kWavefront: factor of what it shows

    std::vector<Binding> group = {reads("Frame", constants),
                                  reads("Objects", scene.objects),
                                  reads("Materials", scene.materials),
                                  reads("Finishes", scene.finishes),
                                  reads("Tangents", scene.tangents),
                                  reads("Indices", scene.indices),
                                  reads("Vertices", scene.vertices),
                                  reads("Appearance", scene.appearance),
                                  reads("Textures", scene.textures),
                                  reads("SceneLights", scene.lights),
                                  reads("Emitters", scene.emitters),
                                  reads("texture_pages", scene.texture_pages),
                                  reads_layer("environment_map", environment, 0),
                                  reads_layer("filtered_environment", filtered_environment, 0),
                                  reads_layer("background_radiance", either(background_radiance), 0),
                                  reads_layer("background_depth", either(background_depth), 0)};
    /// What any pass may look at, by the names that shaders have for it: the scene, its environment and the constants.
    Binding bindings() const { return all_of(group); }

    /// Some pixel may show an opaque surface, of the scene or of the caller's.
    bool has_opaque() const { return !scene.opaque.empty() || background_depth != nullptr; }
    /// Something has to be bound.
    const GpuImage& either(const GpuImage* image) const { return image != nullptr ? *image : environment; }
};

/// The scene of a frame as another view sees it, without light on surfaces. `constants`: a buffer that `view` has been, or will
/// be, written to.
inline Frame seen_from(const Frame& frame, Workspace& workspace, const Buffer& constants,
                       const gpu::FrameConstants& view, vk::Extent2D extent) {
    return {
        workspace, frame.scene, constants, view, frame.environment, frame.filtered_environment, frame.environment_kind,
        extent};
}

}  // namespace pellucid
