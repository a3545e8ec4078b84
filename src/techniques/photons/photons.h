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

/// What sends photons in a picture.
struct PhotonSetup {
    /// Emissive surfaces and the environment aim at this sphere around everything that bends light.
    struct Sphere {
        glm::vec3 center{0.0f};  ///< m, world
        float radius = 0.0f;     ///< m; 0: nothing bends light
    };

    bool any() const { return !views.empty() || emitters || environment != nullptr; }
    /// Views, and one window each for emissive surfaces and the environment.
    std::size_t window_count() const { return views.size() + (emitters ? 1 : 0) + (environment != nullptr ? 1 : 0); }

    std::vector<Light> lights = {};
    /// Finds where light leaves glass, by its frames from the views; null: paths do. Light that the first surface reflects
    /// is left out, and metal sends none.
    const Technique* by = nullptr;
    ParameterMap parameters = {};  ///< of `by`
    LayerBuilder layer_builder = LayerBuilder::kCompute;
    /// Draws what stands between a light and the glass; `by` needs it.
    Opaque (*draw_opaque)(Recorder& recorder, const Frame& frame) = nullptr;
    std::vector<LightView> views = {};  ///< of `side` texels along each side
    std::uint32_t side = 0;
    Sphere targets = {};
    bool emitters = false;            ///< emissive surfaces send photons
    bool emitters_in_solids = false;  ///< some of them may lie in glass
    const EnvironmentShares* environment =
        nullptr;  ///< directions from which the environment sends photons; null: none
};

/// Light that lights, emissive surfaces and the environment send through glass and from metal onto opaque surfaces (Jensen, "Global illumination using photon maps",
/// 1996): every frame traces photons of its own from the lights' views, by the paths of visibility-layers, and sorts them
/// for look-ups.
class Photons {
public:
    explicit Photons(const Device& device) : workspace_(device), store_(device) {}

    /// Before the frames of a picture, when none is in flight. Photons need GpuScene::topology and, on a device that is a CPU,
    /// GpuScene::host_finder.
    void begin(PhotonSetup setup);
    bool any() const { return setup_.any(); }
    bool of_emitters() const { return setup_.emitters; }
    bool of_environment() const { return setup_.environment != nullptr; }
    /// Traces the photons of a frame; `frame.photons` is bindings().
    void record(Recorder& recorder, const Frame& frame);
    /// What look-ups bind; its address does not change. Null: there are no photons.
    const std::vector<Binding>* bindings() const { return any() ? &bindings_ : nullptr; }
    /// As LayerSource::must_repeat().
    bool must_repeat(const Frame& frame);
    /// Forgets what it has learnt of a scene.
    void forget() {
        source_ = LayerSource();
        store_ = PhotonStore(workspace_.device());
    }
    /// Whether frames from now on measure flux().
    void count_flux(bool counts) { counts_ = counts; }
    /// Of the last frame that has measured it.
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
