#pragma once

#include "techniques/shaders.h"
#include "techniques/technique.h"
#include "techniques/visibility_layers/paths.h"

#include <algorithm>
#include <array>

namespace pellucid {

extern const Technique kVisibilityLayers;

inline constexpr NamedValue kAutomaticBelow[] = {{-1, "automatic", ""}};
inline constexpr NamedValue kAutomaticZero[] = {{0, "automatic", ""}};

/// Technique::parameters of techniques that call follow_paths().
inline constexpr std::array kPathParameters = {
    ParameterInfo{"events", "", 16, 1, 4095, true, "refractions and reflections followed along a path"},
    ParameterInfo{
        "branches", "", -1, -1, 255, true,
        "reflected ways followed per pixel and sample; automatic: none in a picture of one sample, 16 otherwise",
        kAutomaticBelow},
    ParameterInfo{"threshold", "", 0.01, 0, 1, false, "share of the light that a reflected way carries at least"},
    ParameterInfo{"one-branch", "", 0, 0, 1, true,
                  "each sample takes one way at random, refracted or reflected, and through rough glass one facet",
                  kOffOn},
    ParameterInfo{"surfaces-per-pass", "", 0, 0, 64, true,
                  "surfaces that a path meets in one dispatch, a matter of time; automatic: chosen for the device",
                  kAutomaticZero},
    ParameterInfo{"photons", "", -1, -1, 4194304, true,
                  "photons of every light, of emissive surfaces and of the environment in every frame: light that "
                  "glass or polished metal sends onto opaque "
                  "surfaces; automatic: 16384 with "
                  "--light full, none otherwise",
                  kAutomaticBelow},
    ParameterInfo{"layers", "", 1, 1, 64, true,
                  "surfaces along a view ray that the AOV `layers` counts at most; paths look at all that there are"},
};

/// These, and one more of the technique's own.
constexpr auto path_parameters_and(const ParameterInfo& own) {
    std::array<ParameterInfo, kPathParameters.size() + 1> all{};
    std::copy(kPathParameters.begin(), kPathParameters.end(), all.begin());
    all.back() = own;
    return all;
}

/// Technique::programs and Technique::prepare of techniques that call follow_paths().
inline constexpr std::initializer_list<const ShaderCode*> kPathPrograms = {
    &shaders::begin_paths_comp, &shaders::begin_at_eye_comp, &shaders::begin_on_opaque_comp,
    &shaders::follow_paths_comp, &shaders::end_paths_comp};
void prepare_paths(const Preparation& preparation, const ParameterValues& parameters);
/// Follows the view rays through `map`: from the first surface of `layers` on or, with `volumes`, where surfaces may lie at
/// one place or where the eye is in a solid, from the eye on.
Refraction follow_paths(Recorder& recorder, const Frame& frame, const Layers& layers, const SurfaceMap& map,
                        const ParameterValues& parameters, const PathVolumes* volumes = nullptr);
/// The same where `finder`, which is up to date, finds the surfaces. Needs a device whose memory is the host's.
Refraction follow_paths(Recorder& recorder, const Frame& frame, const Layers& layers, const HostFinder& finder,
                        const ParameterValues& parameters);
/// The same where the device traces rays through `hierarchy`, which is up to date. Needs Device::ray_tracing().
Refraction follow_paths(Recorder& recorder, const Frame& frame, const Layers& layers, const SceneHierarchy& hierarchy,
                        const ParameterValues& parameters);

/// The scene's finder on the host, made where there is none yet; to be brought up to date.
HostFinder& host_finder_of(const Preparation& preparation);

/// Prepares light_surfaces() for techniques that do not follow paths.
void prepare_light(const Preparation& preparation);
/// Adds to the radiance of the opaque surfaces that pixels show, also behind glass, what Frame::light asks for. Techniques that
/// call follow_paths() have it done there.
void light_surfaces(Recorder& recorder, const Frame& frame, const Layers& layers);

/// What gather_irradiance() has found, per pixel. Alpha of `sky` is the cosine of a direction to the environment, 0 where there
/// is none; its other channels are 1 if that is open.
struct Gathered {
    const GpuImage& irradiance;  ///< RGB, W/m2
    const GpuImage& sky;
};

/// Follows a view ray from every pixel to a diffuse surface, and one ray from there. `points` gets where that is
/// (light/irradiance_points.glsl), what it returns the irradiance that the ray stands for: light that other
/// surfaces reflect, by up to FrameLight::bounces rays and what Frame::irradiance holds of more.
Gathered gather_irradiance(Recorder& recorder, const Frame& frame, LayerSource& source, const Buffer& points);

}  // namespace pellucid
