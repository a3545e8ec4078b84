// Presets: each names the techniques that it stands for, the first of which that the device offers is taken.
// docs/techniques.md says what was measured.
#include "techniques/technique.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

namespace pellucid {
namespace {

struct Preset {
    PresetInfo info;
    std::vector<TechniqueChoice> choices;
};

const std::array<Preset, 3>& all_presets() {
    static const ParameterMap kToTheLast = {{"events", 64.0}, {"branches", 64.0}, {"threshold", 0.001}};
    static const std::array<Preset, 3> kPresets{{
        {{"fast", "for pictures that move: one way through the glass per pixel"},
         {{&find_technique("ray-tracing"), {{"branches", 0.0}}}, {&find_technique("wang-2014"), {}}}},
        {{"balanced", "whole scenes: every interface, and what it reflects while that is a hundredth of the light"},
         {{&find_technique("ray-tracing-cpu"), {}}, {&find_technique("visibility-layers"), {}}}},
        {{"exact", "the same to the last reflection that can be seen: 64 interfaces, a thousandth of the light"},
         {{&find_technique("ray-tracing-cpu"), kToTheLast}, {&find_technique("visibility-layers"), kToTheLast}}},
    }};
    return kPresets;
}

}  // namespace

std::span<const PresetInfo> presets() {
    static const std::array<PresetInfo, 3> kInfos = [] {
        std::array<PresetInfo, 3> infos;
        std::transform(all_presets().begin(), all_presets().end(), infos.begin(),
                       [](const Preset& preset) { return preset.info; });
        return infos;
    }();
    return kInfos;
}

void check_technique_name(std::string_view name) {
    std::vector<std::string_view> known;
    for (const PresetInfo& preset : presets()) known.push_back(preset.name);
    for (const TechniqueInfo* info : techniques()) known.push_back(info->name);
    if (std::find(known.begin(), known.end(), name) == known.end())
        throw Error(fmt::format("unknown technique '{}'; known: {}", name, fmt::join(known, ", ")));
}

TechniqueChoice choose_technique(std::string_view name, const Device& device, bool volumes) {
    check_technique_name(name);
    for (const Preset& preset : all_presets()) {
        if (preset.info.name != name) continue;
        if (volumes) return {&find_technique("ihrke-2007"), {}};
        const auto offered =
            std::find_if(preset.choices.begin(), preset.choices.end(),
                         [&](const TechniqueChoice& choice) { return lacking_for(device, *choice.technique).empty(); });
        return offered != preset.choices.end() ? *offered : preset.choices.back();
    }
    return {&find_technique(name), {}};
}

}  // namespace pellucid
