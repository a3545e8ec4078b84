#include "techniques/ihrke_2007/ihrke_2007.h"
#include "techniques/kay_greenberg_1979/kay_greenberg_1979.h"
#include "techniques/oliveira_brauwers_2007/oliveira_brauwers_2007.h"
#include "techniques/one_interface/one_interface.h"
#include "techniques/path/path.h"
#include "techniques/ray_tracing/ray_tracing.h"
#include "techniques/ray_tracing_cpu/ray_tracing_cpu.h"
#include "techniques/reference/reference.h"
#include "techniques/technique.h"
#include "techniques/visibility_cube/visibility_cube.h"
#include "techniques/visibility_layers/visibility_layers.h"
#include "techniques/wang_2014/wang_2014.h"
#include "techniques/wyman_2005/wyman_2005.h"

#include <pellucid/error.h>
#include <pellucid/names.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pellucid {
namespace {

// Every technique, and the truths that they are measured against, one line each.
constexpr std::array kTechniques = {
    &kOneInterface, &kKayGreenberg1979, &kWyman2005,      &kOliveiraBrauwers2007, &kIhrke2007,
    &kWang2014,     &kVisibilityLayers, &kVisibilityCube, &kRayTracing,           &kRayTracingCpu,
};
constexpr std::array kTruths = {&kPath, &kReference};

constexpr auto kInfos = [] {
    std::array<const TechniqueInfo*, kTechniques.size() + kTruths.size()> infos{};
    const auto info = [](const auto* row) { return &row->info; };
    std::transform(kTruths.begin(), kTruths.end(),
                   std::transform(kTechniques.begin(), kTechniques.end(), infos.begin(), info), info);
    return infos;
}();

/// The row of that name, or null.
template <class Rows>
auto find_row(const Rows& rows, std::string_view name) {
    const auto found = std::find_if(rows.begin(), rows.end(), [&](const auto* row) { return row->info.name == name; });
    return found == rows.end() ? nullptr : *found;
}

void check_value(const TechniqueInfo& technique, const ParameterInfo& parameter, double value) {
    if (!(value >= parameter.minimum && value <= parameter.maximum) ||
        (parameter.whole && value != std::floor(value))) {
        throw Error(fmt::format("{}: {} must be {} {} to {}, not {}", technique.name, parameter.name,
                                parameter.whole ? "a whole number from" : "from", parameter.minimum, parameter.maximum,
                                value));
    }
}

}  // namespace

std::span<const TechniqueInfo* const> techniques() { return kInfos; }

const TechniqueInfo& find_technique(std::string_view name) {
    std::vector<std::string_view> known;
    for (const TechniqueInfo* info : kInfos) {
        if (info->name == name) return *info;
        known.push_back(info->name);
    }
    throw unknown_name("technique", name, known);
}

const Technique* technique_of(const TechniqueInfo& info) { return find_row(kTechniques, info.name); }
const Truth* truth_of(const TechniqueInfo& info) { return find_row(kTruths, info.name); }

std::string lacking_for(const Device& device, const TechniqueInfo& info) {
    const Technique* technique = technique_of(info);
    if (technique == nullptr) return {};
    std::string lacking = technique->lacking ? technique->lacking(device) : std::string();
    for (const ShaderCode* shader : technique->programs)
        if (lacking.empty()) lacking = lacking_limit(*shader, device.limits());
    return lacking;
}

ParameterValues::ParameterValues(const TechniqueInfo& technique, const ParameterMap& given) : technique_(technique) {
    for (const ParameterInfo& parameter : technique.parameters) {
        const auto found = given.find(parameter.name);
        values_.push_back(found == given.end() ? parameter.default_value : found->second);
        check_value(technique, parameter, values_.back());
    }
    for (const auto& [name, value] : given) {
        std::vector<std::string_view> known;
        for (const ParameterInfo& parameter : technique.parameters) known.push_back(parameter.name);
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            throw Error(fmt::format("{} has no parameter '{}'{}; it has: {}", technique.name, name,
                                    did_you_mean(name, known),
                                    known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", "))));
        }
    }
}

double ParameterValues::operator[](std::string_view name) const {
    const auto& all = technique_.parameters;
    const auto found = std::find_if(all.begin(), all.end(), [&](const ParameterInfo& p) { return p.name == name; });
    return values_.at(std::size_t(found - all.begin()));
}

bool ParameterValues::has(std::string_view name) const {
    const auto& all = technique_.parameters;
    return std::any_of(all.begin(), all.end(), [&](const ParameterInfo& p) { return p.name == name; });
}

Refraction allocate_refraction(const Frame& frame, bool with_radiance) {
    Workspace& workspace = frame.workspace;
    const auto vectors = vk::Format::eR32G32B32A32Sfloat;
    return {workspace.image("exit direction", vectors, frame.extent),
            workspace.image("exit position", vectors, frame.extent),
            workspace.image("transmittance", vectors, frame.extent),
            workspace.image("path events", vk::Format::eR32Uint, frame.extent),
            with_radiance ? &workspace.image("path radiance", vectors, frame.extent) : nullptr};
}

Refraction clear_refraction(Recorder& recorder, const Frame& frame, bool with_radiance) {
    const Refraction refraction = allocate_refraction(frame, with_radiance);
    recorder.clear(refraction.events, vk::ClearColorValue(std::array{0u, 0u, 0u, 0u}));
    return refraction;
}

PathEvents unpack_events(std::uint32_t word) {
    return {word & 0xfffu, (word >> 12) & 0xfffu, Status((word >> 24) & 0xfu), ((word >> 28) & 1u) != 0};
}

std::uint32_t pack_events(const PathEvents& events) {
    return std::min(events.interfaces, 0xfffu) | std::min(events.reflections, 0xfffu) << 12 |
           std::uint32_t(events.status) << 24 | (events.side_conflict ? 1u << 28 : 0u);
}

}  // namespace pellucid
