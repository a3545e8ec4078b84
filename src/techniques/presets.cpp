// Presets: each names techniques that it may stand for; the fastest that the device offers is taken.
#include "techniques/technique.h"

#include <pellucid/names.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

namespace pellucid {
namespace {

struct Preset {
    PresetInfo info;
    std::vector<TechniqueChoice> choices;
};

/// Those that draw the same picture of whole scenes, and whose work does not grow with the meshes of the scene.
std::vector<TechniqueChoice> whole_scenes(const ParameterMap& parameters) {
    std::vector<TechniqueChoice> choices;
    for (const char* name : {"ray-tracing-cpu", "ray-tracing", "visibility-layers"})
        choices.push_back({&find_technique(name), parameters});
    return choices;
}

/// The fastest of them on the device, and what says so.
TechniqueChoice fastest(const std::vector<TechniqueChoice>& choices, const Device& device, const MeasuredTimes& times,
                        bool recorded) {
    std::vector<TechniqueChoice> offered;
    std::copy_if(choices.begin(), choices.end(), std::back_inserter(offered), [&](const TechniqueChoice& choice) {
        return lacking_for(device, *choice.technique).empty() && (choice.technique->recordable || !recorded);
    });
    if (offered.empty()) return choices.back();
    if (offered.size() == 1) return offered.front();
    std::vector<std::string_view> names;
    for (const TechniqueChoice& choice : offered) names.push_back(choice.technique->name);
    const std::vector<double> all_ms = times(names);
    TechniqueChoice& choice = offered[std::size_t(std::min_element(all_ms.begin(), all_ms.end()) - all_ms.begin())];
    choice.reason = "measured once on this device, ms per frame:";
    for (std::size_t i = 0; i < names.size(); ++i)
        choice.reason += fmt::format("{} {} {:.1f}", i == 0 ? "" : ",", names[i], all_ms[i]);
    return choice;
}

const std::array<Preset, 3>& all_presets() {
    static const ParameterMap kToTheLast = {{"events", 64.0}, {"branches", 64.0}, {"threshold", 0.001}};
    static const std::array<Preset, 3> kPresets{{
        {{"fast", "for pictures that move: one way through the glass per pixel"},
         {{&find_technique("ray-tracing"), {{"branches", 0.0}}}, {&find_technique("wang-2014"), {}}}},
        {{"balanced", "whole scenes: every interface, and what it reflects while that is a hundredth of the light"},
         whole_scenes({})},
        {{"exact", "the same to the last reflection that can be seen: 64 interfaces, a thousandth of the light"},
         whole_scenes(kToTheLast)},
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
    if (std::find(known.begin(), known.end(), name) == known.end()) throw unknown_name("technique", name, known);
}

TechniqueChoice choose_technique(std::string_view name, const Device& device, bool volumes, const MeasuredTimes& times,
                                 bool recorded) {
    check_technique_name(name);
    for (const Preset& preset : all_presets()) {
        if (preset.info.name != name) continue;
        if (volumes) return {&find_technique("ihrke-2007"), {}};
        return fastest(preset.choices, device, times, recorded);
    }
    return {&find_technique(name), {}};
}

}  // namespace pellucid
