#pragma once

#include "gpu/environment_shares.h"
#include "light/light_views.h"
#include "light/photon_store.h"
#include "light/photon_windows.h"
#include "techniques/technique.h"

#include <pellucid/photon_flux.h>
#include <pellucid/scene.h>

#include <cstdint>
#include <vector>

namespace pellucid {

/// Sources of photons in an image.
struct PhotonSetup {
    /// Sphere around everything that bends light. Emissive surfaces and the environment aim at it.
    struct Sphere {
        glm::vec3 center{0.0f};  ///< m, world
        float radius = 0.0f;     ///< m; 0: nothing bends light
    };

    bool any() const { return !views.empty() || emitters || environment != nullptr; }
    /// Number of windows: one per view, and one each for emissive surfaces and the environment.
    std::size_t window_count() const { return views.size() + (emitters ? 1 : 0) + (environment != nullptr ? 1 : 0); }

    std::vector<Light> lights = {};
    /// Technique that finds the exits from glass, by frames from the views; null: photons follow paths. With a
    /// technique, light reflected by the first surface and light from metal are missing.
    const Technique* by = nullptr;
    ParameterMap parameters = {};  ///< of `by`
    LayerBuilder layer_builder = LayerBuilder::kCompute;
    /// Draws occluders between a light and the glass; required by `by`.
    Opaque (*draw_opaque)(Recorder& recorder, const Frame& frame) = nullptr;
    std::vector<LightView> views = {};  ///< views with `side` texels per side
    std::uint32_t side = 0;
    Sphere targets = {};
    bool emitters = false;                           ///< emissive surfaces send photons
    bool emitters_in_solids = false;                 ///< some emissive surfaces may lie in glass
    const EnvironmentShares* environment = nullptr;  ///< directions sampled for the environment's photons; null: none
};

/// Light from lights, emissive surfaces and the environment that reaches opaque surfaces through glass or from metal
/// (Jensen, "Global illumination using photon maps", 1996). Every frame traces its own photons from the lights' views,
/// with the paths of visibility-layers, and sorts them for look-ups.
class Photons {
public:
    explicit Photons(const Device& device) : workspace_(device), store_(device) {}

    /// Call before the frames of an image, when no frame is in flight. Photons need GpuScene::topology and, on a CPU
    /// device, GpuScene::host_finder.
    void begin(PhotonSetup setup);
    bool any() const { return setup_.any(); }
    bool of_emitters() const { return setup_.emitters; }
    bool of_environment() const { return setup_.environment != nullptr; }
    /// Traces the photons of a frame. `frame.photons` must be bindings().
    void record(Recorder& recorder, const Frame& frame);
    /// Bindings for look-ups, at a constant address; null without photons.
    const std::vector<Binding>* bindings() const { return any() ? &bindings_ : nullptr; }
    /// As LayerSource::must_repeat().
    bool must_repeat(const Frame& frame);
    /// Forgets everything learnt about a scene.
    void forget() {
        source_ = LayerSource();
        store_ = PhotonStore(workspace_.device());
    }
    /// Sets whether further frames measure flux().
    void count_flux(bool counts) { counts_ = counts; }
    /// Flux of the last frame that measured it.
    const PhotonFlux& flux() const { return flux_; }

private:
    Frame light_frame(const Frame& frame);
    std::vector<PhotonWindow> windows_of(const Frame& frame) const;
    void set_scale(const Frame& frame, float width);
    const Buffer& write_windows(Recorder& recorder, const Frame& frame);
    const Buffer& gather_exits(Recorder& recorder, const Frame& from_light, const Buffer& windows);
    void count(Recorder& recorder, const Frame& from_light);

    Workspace workspace_;
    LayerSource source_;
    PhotonSetup setup_;
    PhotonStore store_;
    std::vector<Binding> bindings_;
    PhotonScale scale_{};
    PhotonFlux flux_;
    bool counts_ = false;
};

}  // namespace pellucid
