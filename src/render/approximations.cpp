#include "render/approximations.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

namespace pellucid {
namespace {

std::size_t translucent_objects(const Scene& scene) {
    return std::size_t(std::count_if(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
        return scene.materials[std::size_t(object.material)].translucent();
    }));
}

std::size_t rough_glass_objects(const Scene& scene) {
    return std::size_t(std::count_if(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
        const Material& material = scene.materials[std::size_t(object.material)];
        return material.refractive() && material.roughness > 0.0f;
    }));
}

/// What the path tracer leaves out of volumes. It names itself the lights whose light needs photons there.
std::vector<std::string> volumes_of_truth(const Scene& scene) {
    std::vector<std::string> lines;
    const auto any = [&](auto has) {
        return std::any_of(scene.volume_objects.begin(), scene.volume_objects.end(),
                           [&](const VolumeObject& object) { return has(*scene.volumes[std::size_t(object.volume)]); });
    };
    if (any([](const Volume& volume) { return !volume.sigma_s.empty(); }))
        lines.emplace_back("light that volumes scatter is lost");
    return lines;
}

/// What frames leave out of the light of lights. Numbers of refracting and of opaque objects.
std::vector<std::string> light_left_out(const Scene& scene, const TechniqueInfo& technique, const LightOptions& light,
                                        std::size_t refractive, std::size_t opaque, bool photons) {
    const std::size_t translucent = translucent_objects(scene);
    const std::size_t lit_glass = technique.lit_glass     ? refractive
                                  : technique.whole_scene ? rough_glass_objects(scene)
                                                          : 0;
    const std::size_t lit = opaque + lit_glass;
    const bool shown = light.transport != LightTransport::kEnvironment, followed = shown && lit > 0;
    if (!followed && translucent == 0) {  // lights with a size are seen themselves
        const auto counts = [&](const Light& each) { return !shown || !has_size(each); };
        const auto count = std::count_if(scene.lights.begin(), scene.lights.end(), counts);
        if (count == 0) return {};
        return {fmt::format("{} light{}{} not drawn", count, count == 1 ? "" : "s",
                            std::string(shown ? " without a size" : "") + (count == 1 ? " is" : " are"))};
    }
    if (!followed && translucent < scene.objects.size()) return {"lights light translucent objects only"};
    if (!followed || refractive == 0 || opaque == 0 || (photons && light.shadows == Shadows::kExact)) return {};
    if (light.shadows == Shadows::kTinted) return {"the light of lights goes straight through glass"};
    const bool has_photons = std::any_of(technique.parameters.begin(), technique.parameters.end(),
                                         [](const ParameterInfo& parameter) { return parameter.name == "photons"; });
    return {fmt::format("glass casts shadows, but the light of lights that it bends is not drawn{}",
                        has_photons ? " (--photons N draws it)" : "")};
}

}  // namespace

bool has_size(const Light& light) {
    return (light.kind == Light::Kind::kDirectional ? light.angular_diameter : light.radius) > 0.0f;
}

std::vector<std::string> approximations(const Scene& scene, const TechniqueInfo& technique, const LightOptions& light,
                                        bool photons) {
    std::vector<std::string> lines;
    if (!scene.volume_objects.empty() && !technique.volumes) {
        const std::size_t count = scene.volume_objects.size();
        lines.push_back(
            fmt::format("{} volume{} not drawn (ihrke-2007 draws volumes)", count, count == 1 ? " is" : "s are"));
    }
    if (technique.all_light) {
        const std::vector<std::string> left_out = volumes_of_truth(scene);
        lines.insert(lines.end(), left_out.begin(), left_out.end());
        return lines;
    }
    std::set<int> used;
    std::size_t refractive = 0, thin = 0, opaque = 0;
    for (const Object& object : scene.objects) {
        const Material& material = scene.materials[std::size_t(object.material)];
        used.insert(object.material);
        refractive += material.refractive() ? 1 : 0;
        thin += material.transmissive() && !material.refractive() ? 1 : 0;
        opaque += material.transmissive() ? 0 : 1;
    }
    for (const int index : used) {
        const Material& material = scene.materials[std::size_t(index)];
        const std::string name = material.name.empty() ? fmt::format("{}", index) : material.name;
        if (!technique.whole_scene && material.refractive() && material.dispersion > 0.0f) {
            lines.push_back(fmt::format("material {}: dispersion is not drawn", name));
        }
        if (material.transmissive() && material.roughness > 0.0f && !(technique.whole_scene && material.refractive())) {
            lines.push_back(fmt::format("material {}: rough glass is drawn smooth", name));
        }
        if (material.transmissive() && material.normal_texture.image >= 0 &&
            !(technique.whole_scene && material.refractive()))
            lines.push_back(fmt::format("material {}: the normal texture of glass is not drawn", name));
        if (material.translucent() && (!material.finish.plain() || material.normal_texture.image >= 0))
            lines.push_back(
                fmt::format("material {}: light of lights meets it without its normal texture and finish", name));
        if (material.transmissive() && material.emission != glm::vec3(0.0f)) {
            lines.push_back(fmt::format("material {}: the emission of glass is not drawn", name));
        }
    }
    if (refractive > 1 && !technique.many_media) {
        lines.push_back(fmt::format("behind the first surface {} refracting objects count as one solid", refractive));
    }
    if (refractive > 0 && opaque + thin > 0 && !technique.whole_scene) {
        lines.push_back(
            technique.opaque_behind
                ? "through refracting glass only those opaque surfaces are seen that the picture shows, and no thin "
                  "walls"
                : "opaque objects and thin walls are drawn where they are seen directly, not through refracting glass");
    }
    if (technique.volumes && !scene.lights.empty() && photons)
        lines.emplace_back("wavefronts bring the light of lights: photons sent besides are not looked up");
    // A technique that draws volumes says itself what lights do: glass may have become a volume.
    if (!technique.volumes && !scene.lights.empty()) {
        const std::vector<std::string> left_out = light_left_out(scene, technique, light, refractive, opaque, photons);
        lines.insert(lines.end(), left_out.begin(), left_out.end());
    }
    return lines;
}

std::vector<std::string> unknown_solids(const SceneTopology& topology, const TechniqueInfo& technique) {
    std::vector<std::string> lines;
    if (const std::size_t count = topology.with_inner_walls; count > 0) {
        lines.push_back(
            fmt::format("{}: {} of shells that may overlap or cross themselves, where a ray leaves at the "
                        "first face that leads out",
                        technique.name, count == 1 ? "a solid" : fmt::format("{} solids", count)));
    }
    if (topology.eye_in_solid || topology.eye_differs)
        lines.push_back(
            fmt::format("{}: the camera may be inside a solid, but is taken to be outside of all", technique.name));
    return lines;
}

namespace {

/// One line where more than 1% of the glass pixels have a status other than ok: how many, and of which status.
std::optional<std::string> bad_status_warning(const RenderResult& result, const TechniqueInfo& technique) {
    const std::uint64_t bad = result.covered - result.status[std::size_t(Status::kOk)];
    if (100 * bad <= result.covered) return std::nullopt;
    std::string causes;
    for (std::size_t status = 0; status < result.status.size(); ++status) {
        if (Status(status) == Status::kOk || result.status[status] == 0) continue;
        causes +=
            fmt::format("{}{} {}", causes.empty() ? "" : ", ", result.status[status], status_name(Status(status)));
    }
    return fmt::format("{}: {} of {} glass pixels may be wrong by their status: {}", technique.name, bad,
                       result.covered, causes);
}

}  // namespace

void warn_of(RenderResult& result, const FrameSettings& chosen, bool cut, const RenderSettings& settings) {
    if (auto warning = bad_status_warning(result, chosen.info)) result.warnings.push_back(*warning);
    if (result.cut_rays > 0) {
        result.warnings.push_back(fmt::format(
            "light meets more than {} surfaces on its way to {} pixels: what is behind them counts as a gap",
            settings.thickness.layers, result.cut_rays));
    }
    if (settings.error > 0.0f) {
        const auto& counts = result.sample_counts.pixels;
        const auto capped = std::count(counts.begin(), counts.end(), float(settings.most_samples));
        if (capped > 0)
            result.warnings.push_back(
                fmt::format("{} pixels have {} samples, the most: their error may be more than {}", capped,
                            settings.most_samples, settings.error));
    }
    if (cut && chosen.technique && chosen.technique->searches_layers) {
        result.warnings.push_back(fmt::format(
            "drawn in tiles: {} finds no surface that lies beyond the tile of the pixel", chosen.info.name));
    }
}

}  // namespace pellucid
