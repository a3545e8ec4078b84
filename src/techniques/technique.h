#pragma once

#include "bake/bake_cache.h"
#include "layers/layers.h"

#include <pellucid/progress.h>
#include <pellucid/technique.h>

#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace pellucid {

/// Names of values that several techniques have.
inline constexpr NamedValue kOffOn[] = {{0, "off", ""}, {1, "on", ""}};
inline constexpr NamedValue kBackFaceNames[] = {{0, "first", "back face"}, {1, "farthest", "back face"}};

/// Per pixel, where the view ray ends up after the glass. What follows never asks which technique
/// filled it. A pixel without glass has no events, and all else is undefined there.
struct Refraction {
    const GpuImage& exit_direction;  ///< RGBA32F: unit world direction; w: path length inside media, m
    /// RGBA32F: world position of the path's end, m: where it leaves the last interface, or meets an opaque object;
    /// w: that object's index, or kEndsInEnvironment
    const GpuImage& exit_position;
    const GpuImage& transmittance;  ///< RGBA32F: rgb, Fresnel and absorption along the path, 0..1
    const GpuImage& events;         ///< R32UI: see unpack_events()
    /// RGBA32F: radiance picked up on the way, that of an opaque object at the end included, as it reaches the eye;
    /// a: 1 where such an object hides the environment. Null: none anywhere.
    const GpuImage* radiance = nullptr;
    /// RGBA32F: radiance that the first surface reflects, as it reaches the eye. Null: the environment's, which shade()
    /// looks up.
    const GpuImage* reflected = nullptr;
    /// `reflected` is what rough glass reflects of lights, and shade() adds the environment's. Transmittance has a: 1 where suns
    /// are seen at the path's end, 0 where `radiance` has their light.
    bool reflects_lights_alone = false;
    /// RGBA32F: radiance, to which `reflected` is added, of pixels that the technique has shaded itself, where a is 1.
    /// Null: none.
    const GpuImage* picture = nullptr;
    /// Samples along a side of a pixel's footprint in the environment, over which shade() averages; 0: one direction.
    std::uint32_t footprint = 0;
    bool everywhere = false;  ///< pixels without glass hold the view ray, and what it meets

    std::vector<Binding> group = {updates("exit_direction", exit_direction), updates("exit_position", exit_position),
                                  updates("transmittance", transmittance), updates("path_events", events)};
    /// The first four by the names that shaders have for them.
    Binding bindings() const { return all_of(group); }
};
/// `with_radiance`: for techniques that pick up radiance.
Refraction allocate_refraction(const Frame& frame, bool with_radiance = false);
/// The same without events: a technique has to write the pixels with glass only.
Refraction clear_refraction(Recorder& recorder, const Frame& frame, bool with_radiance = false);

/// Refraction::exit_position.w of a path that no opaque object ends; otherwise it is the object's index.
inline constexpr float kEndsInEnvironment = -1.0f;

/// The word in Refraction::events; twin of pack_events in refraction.glsl.
struct PathEvents {
    std::uint32_t interfaces;   ///< refractions and reflections, the first interface included
    std::uint32_t reflections;  ///< total internal reflections among them
    Status status;
    bool side_conflict;  ///< somewhere the shading normal faced the other side than the surface
};
PathEvents unpack_events(std::uint32_t word);
std::uint32_t pack_events(const PathEvents& events);

/// A technique's parameters with their values.
class ParameterValues {
public:
    /// Throws Error for an unknown name (listing the known ones) or a value out of range.
    ParameterValues(const TechniqueInfo& technique, const ParameterMap& given);
    double operator[](std::string_view name) const;
    bool has(std::string_view name) const;
    std::uint32_t whole(std::string_view name) const { return std::uint32_t((*this)[name]); }

private:
    const TechniqueInfo& technique_;
    std::vector<double> values_;
};

/// What a technique computes from the scene before the first frame that needs it.
struct Preparation {
    const Device& device;
    const Scene& scene;
    GpuScene& gpu_scene;  ///< its `prepared` takes the result
    bake::BakeCache& cache;
    std::uint32_t threads;  ///< 0: all cores
    const Progress& progress;
    std::vector<std::string>& warnings;
    bool recorded = false;  ///< Frame::recorded of the frames to come
};

/// A row of the registry: what the technique is, what it needs, and how it is recorded.
struct Technique {
    TechniqueInfo info;
    std::initializer_list<const ShaderCode*> programs = {};  ///< compute shaders, whose limits a device must have
    /// What else the device lacks for it, in words that follow "needs"; empty: nothing. Null: any device will do.
    std::string (*lacking)(const Device& device) = nullptr;
    std::uint32_t (*layer_count)(const ParameterValues& parameters);
    /// Called before every picture; does its work in the first that needs it. Null: there is nothing to do.
    void (*prepare)(const Preparation& preparation, const ParameterValues& parameters) = nullptr;
    /// `layers` are of all solids together.
    Refraction (*record)(Recorder& recorder, const Frame& frame, const Layers& layers,
                         const ParameterValues& parameters);
    /// It looks for surfaces in layers of other pixels: in a tile of a picture it knows nothing of the others.
    bool searches_layers = false;
    /// View::kWavefront: draws the wavefronts of light over `radiance` (RGBA32F), where the scene has been shaded. Null: the
    /// technique traces none. Throws Error if there are none in this scene.
    void (*draw_light)(Recorder& recorder, const Frame& frame, const Opaque& opaque,
                       const GpuImage& radiance) = nullptr;
    /// After a picture: what in it is not as it should be, a line each. Null: nothing ever.
    void (*report)(const GpuScene& scene, std::vector<std::string>& warnings) = nullptr;
};
/// Null for a truth (truth.h).
const Technique* technique_of(const TechniqueInfo& info);
/// What the device lacks for it, in words that follow "needs"; empty: nothing.
std::string lacking_for(const Device& device, const TechniqueInfo& info);
/// See Renderer::choose().
/// `volumes`: the scene has some, and presets stand for what draws them. `times`: milliseconds per frame of techniques on
/// this device, asked for where a preset may stand for several.
using MeasuredTimes = std::function<std::vector<double>(std::span<const std::string_view> techniques)>;
/// `recorded`: presets stand for techniques that are recordable.
TechniqueChoice choose_technique(std::string_view name, const Device& device, bool volumes, const MeasuredTimes& times,
                                 bool recorded = false);

}  // namespace pellucid
