#pragma once

#include <pellucid/api.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace pellucid {

/// Which light the frames of a technique follow to opaque surfaces. Truths follow all of it.
enum class LightTransport {
    /// kEnvironment in scenes without lights and emissive objects, kFull in stills of 8 samples or more, kDirect otherwise
    /// (default).
    kAutomatic,
    kEnvironment,  ///< the environment's, unshadowed, as if each surface stood alone; lights of the scene are left out
    kDirect,       ///< kEnvironment and the light of suns, lamps and spots, with shadows
    kFull,         ///< kDirect, diffuse reflections between surfaces, and what hides the environment
};
/// The value of a name: automatic, environment, direct, full. Throws Error listing them.
PELLUCID_API LightTransport parse_light_transport(std::string_view name);
PELLUCID_API std::string_view light_transport_name(LightTransport transport);

/// What refracting glass does to the straight ray from a light to a surface. Thin walls tint it in both.
enum class Shadows {
    kExact,   ///< glass blocks it: what passes is bent, and comes as a caustic
    kTinted,  ///< glass lets it pass straight on, weakened by absorption, tint and Fresnel reflection
};
/// The value of a name: exact, tinted. Throws Error listing them.
PELLUCID_API Shadows parse_shadows(std::string_view name);

struct LightOptions {
    LightTransport transport = LightTransport::kAutomatic;
    Shadows shadows = Shadows::kExact;
    /// Technique that finds where the light of photons leaves glass, run from the lights' views; empty: photons follow every
    /// interface, reflections included. Techniques that see the whole scene do as empty does.
    std::string caustics = {};
    std::uint32_t bounces = 2;  ///< reflections that rays follow, 0 to 7, before a cache has the rest; kFull

    bool operator==(const LightOptions&) const = default;
};

}  // namespace pellucid
