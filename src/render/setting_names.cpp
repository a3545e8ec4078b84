// Settings of a renderer by the names that commands use.
#include <pellucid/names.h>
#include <pellucid/renderer.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

namespace pellucid {
namespace {

template <class Enum, std::size_t kCount>
Enum parse_name(std::string_view what, std::string_view name,
                const std::array<std::pair<std::string_view, Enum>, kCount>& known) {
    std::vector<std::string_view> names;
    for (const auto& [text, value] : known) {
        if (text == name) return value;
        names.push_back(text);
    }
    throw unknown_name(what, name, names);
}

constexpr std::array<std::pair<std::string_view, LightTransport>, 4> kLightTransports = {
    {{"automatic", LightTransport::kAutomatic},
     {"environment", LightTransport::kEnvironment},
     {"direct", LightTransport::kDirect},
     {"full", LightTransport::kFull}}};

}  // namespace

View parse_view(std::string_view name) {
    return parse_name<View, 3>(
        "view", name,
        {{{"radiance", View::kRadiance}, {"analysis", View::kAnalysis}, {"wavefront", View::kWavefront}}});
}

LayerBuilder parse_layer_builder(std::string_view name) {
    return parse_name<LayerBuilder, 5>("layer builder", name,
                                       {{{"automatic", LayerBuilder::kAutomatic},
                                         {"single-pass", LayerBuilder::kSinglePass},
                                         {"compute", LayerBuilder::kCompute},
                                         {"depth-peeling", LayerBuilder::kDepthPeeling},
                                         {"dual-depth-peeling", LayerBuilder::kDualDepthPeeling}}});
}

LightTransport parse_light_transport(std::string_view name) {
    return parse_name("light transport", name, kLightTransports);
}

std::string_view light_transport_name(LightTransport transport) {
    return std::find_if(kLightTransports.begin(), kLightTransports.end(),
                        [&](const auto& known) { return known.second == transport; })
        ->first;
}

Shadows parse_shadows(std::string_view name) {
    return parse_name<Shadows, 2>("kind of shadow", name, {{{"exact", Shadows::kExact}, {"tinted", Shadows::kTinted}}});
}

ToneMap parse_tonemap(std::string_view name) {
    return parse_name<ToneMap, 5>("tone map", name,
                                  {{{"none", ToneMap::kNone},
                                    {"reinhard", ToneMap::kReinhard},
                                    {"aces", ToneMap::kAces},
                                    {"neutral", ToneMap::kNeutral},
                                    {"krawczyk", ToneMap::kKrawczyk}}});
}

}  // namespace pellucid
