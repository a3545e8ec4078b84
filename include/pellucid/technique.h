#pragma once

#include <pellucid/api.h>
#include <pellucid/refracted_path.h>

#include <map>
#include <span>
#include <string>
#include <string_view>

namespace pellucid {

/// A value of a parameter that has a name.
struct NamedValue {
    double value;
    std::string_view name;  ///< as on the command line, "refraction"
    std::string_view doc;   ///< a few words; empty where the name says all
};

/// One number that a technique can be given.
struct ParameterInfo {
    std::string_view name;  ///< as on the command line, "steps"
    std::string_view unit;  ///< "m", "px", or "" for a plain number
    double default_value;
    double minimum;
    double maximum;
    bool whole;            ///< whole numbers only
    std::string_view doc;  ///< one line
    /// Names of values. Of a choice, every value has one. Parameters of one name give a name the same value.
    std::span<const NamedValue> names = {};
};

/// The publication that a technique follows; empty authors: none.
struct Source {
    std::string_view authors;
    std::string_view title;
    std::string_view venue;
    int year;
    std::string_view section;
};

/// A way to compute refraction, as the registry lists it.
struct TechniqueInfo {
    std::string_view name;
    std::string_view summary;  ///< one line
    Source source;
    std::span<const ParameterInfo> parameters;
    /// A truth that techniques are measured against: the exact tracer traces it on the CPU. Drawn by its name as a
    /// technique is.
    bool reference = false;
    /// Its picture has all light: reflections inside, opaque things behind glass, lamps, metal, rough glass,
    /// dispersion. RenderSettings::samples are paths per pixel.
    bool all_light = false;
    /// Gives each of several refracting objects its own medium; otherwise they count as one solid behind
    /// the first surface.
    bool many_media = false;
    /// Computes from the scene, once for each shape of it, what its frames then use: that takes time, and progress is
    /// reported.
    bool bakes = false;
    /// Refracted rays see the opaque objects that the picture shows; otherwise the environment only.
    bool opaque_behind = false;
    /// Refracted rays meet everything that there is, wherever it lies: opaque objects, thin walls, rough and dispersive
    /// glass.
    bool whole_scene = false;
    /// Draws volumes (Scene::volumes); otherwise they are left out.
    bool volumes = false;
    /// Lights of the scene light its refracting glass.
    bool lit_glass = false;
    /// Its frames run on the device alone, so that vulkan::Frames can record them into commands of the caller's.
    bool recordable = true;
};

/// Every technique by its publication, then those that trace rays, then the truths (TechniqueInfo::reference).
PELLUCID_API std::span<const TechniqueInfo* const> techniques();

/// Throws Error listing the known names if there is none of this name.
PELLUCID_API const TechniqueInfo& find_technique(std::string_view name);

/// Parameters given by name; what is not named keeps its default.
using ParameterMap = std::map<std::string, double, std::less<>>;

/// A name to give for a technique: it stands for the fastest of those that it may stand for on the device
/// (docs/techniques.md), and for parameters of it.
struct PresetInfo {
    std::string_view name;
    std::string_view summary;  ///< one line
};
/// `fast`, `balanced` and `exact`, in this order.
PELLUCID_API std::span<const PresetInfo> presets();

/// Throws Error listing the known names if there is neither a technique nor a preset of this name.
PELLUCID_API void check_technique_name(std::string_view name);

/// What the name of a technique or preset stands for.
struct TechniqueChoice {
    const TechniqueInfo* technique;
    ParameterMap parameters;  ///< of the preset; others have their defaults
    /// Why a preset stands for it, for the user: what was measured on this device. Empty where there was nothing to choose.
    std::string reason = {};
};

}  // namespace pellucid
