#pragma once

#include <pellucid/api.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace pellucid {

/// Light on opaque surfaces that frames of a technique include. Reference techniques always include all light.
enum class LightTransport {
    /// kEnvironment in scenes without lights and emissive objects, kFull in stills of 8 samples or more, kDirect
    /// otherwise (default).
    kAutomatic,
    kEnvironment,  ///< unshadowed environment light, as if each surface stood alone; the scene's lights are ignored
    kDirect,       ///< kEnvironment plus directional, point and spot lights with shadows
    kFull,         ///< kDirect plus diffuse interreflection and occlusion of the environment
};
/// The light transport with this name: automatic, environment, direct, full. Throws Error listing the names.
PELLUCID_API LightTransport parse_light_transport(std::string_view name);
PELLUCID_API std::string_view light_transport_name(LightTransport transport);

/// Effect of refracting glass on the straight ray from a light to a surface. Thin walls tint this ray with either
/// value.
enum class Shadows {
    kExact,   ///< glass blocks the ray; refracted light arrives as a caustic
    kTinted,  ///< glass passes the ray unbent, attenuated by absorption, tint and Fresnel reflection
};
/// The shadows with this name: exact, tinted. Throws Error listing the names.
PELLUCID_API Shadows parse_shadows(std::string_view name);

struct LightOptions {
    LightTransport transport = LightTransport::kAutomatic;
    Shadows shadows = Shadows::kExact;
    /// Technique that finds where photons leave glass, run from the lights' views. Empty: photons follow every
    /// interface, reflections included. Techniques that see the whole scene behave as if it were empty.
    std::string caustics = {};
    std::uint32_t bounces = 2;  ///< kFull: reflections that rays follow before they read a cache, 0 to 7

    bool operator==(const LightOptions&) const = default;
};

}  // namespace pellucid
