#include "viewer/look_sections.h"

#include "viewer/overlay.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace pellucid::viewer {
namespace {

bool drag(const char* label, float& value, float speed, float least, float most, const char* format = "%.3f") {
    return ImGui::DragFloat(label, &value, speed, least, most, format, ImGuiSliderFlags_AlwaysClamp);
}

bool drag_double(const char* label, double& value, float speed, double least, double most, const char* format) {
    return ImGui::DragScalar(label, ImGuiDataType_Double, &value, speed, &least, &most, format,
                             ImGuiSliderFlags_AlwaysClamp);
}

void tooltip(std::string_view text) {
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(320.0f);
    ImGui::TextUnformatted(text.data(), text.data() + text.size());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

bool choice(std::string& chosen, std::string_view name, std::string_view summary, const std::string& lacking = {}) {
    const bool picked = ImGui::Selectable(std::string(name).c_str(), chosen == name,
                                          lacking.empty() ? 0 : ImGuiSelectableFlags_Disabled);
    tooltip(lacking.empty() ? summary : fmt::format("needs {}", lacking));
    if (picked) chosen = name;
    return picked;
}

void technique_combo(const char* label, std::string& chosen, const Renderer& renderer, bool may_be_none) {
    if (!ImGui::BeginCombo(label, chosen.empty() ? "none" : chosen.c_str(), ImGuiComboFlags_HeightLarge)) return;
    if (may_be_none && ImGui::Selectable("none", chosen.empty())) chosen.clear();
    for (const PresetInfo& preset : presets()) choice(chosen, preset.name, preset.summary);
    ImGui::Separator();
    for (const TechniqueInfo* technique : techniques())
        choice(chosen, technique->name, technique->summary, renderer.lacking(*technique));
    ImGui::EndCombo();
}

/// A choice among named values. True: another was chosen.
bool value_combo(const char* label, std::span<const NamedValue> names, double& value) {
    const auto current = std::ranges::find(names, value, &NamedValue::value);
    const std::string shown(current == names.end() ? "" : current->name);
    if (!ImGui::BeginCombo(label, shown.c_str())) return false;
    bool changed = false;
    for (const NamedValue& named : names) {
        if (!ImGui::Selectable(std::string(named.name).c_str(), named.value == value)) continue;
        value = named.value;
        changed = true;
    }
    ImGui::EndCombo();
    return changed;
}

void parameter_widget(const ParameterInfo& info, const ParameterMap& of_preset, ParameterMap& given) {
    const auto preset = of_preset.find(info.name);
    const double by_default = preset == of_preset.end() ? info.default_value : preset->second;
    const auto found = given.find(info.name);
    double value = found == given.end() ? by_default : found->second;
    const std::string label = info.unit.empty() ? std::string(info.name) : fmt::format("{}, {}", info.name, info.unit);
    const double range = info.maximum - info.minimum;
    const bool all_named = info.whole && double(info.names.size()) == range + 1.0;
    const float speed = info.whole ? 0.25f : float(std::min(range, 10.0) / 500.0);
    bool changed =
        all_named ? value_combo(label.c_str(), info.names, value)
                  : drag_double(label.c_str(), value, speed, info.minimum, info.maximum, info.whole ? "%.0f" : "%.4g");
    tooltip(fmt::format("{} [{} to {}, default {}]; right click: default", info.doc, info.minimum, info.maximum,
                        by_default));
    if (info.whole) value = std::round(value);
    if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) {
        value = by_default;
        changed = true;
    }
    if (!changed) return;
    if (value == by_default)
        given.erase(std::string(info.name));
    else
        given[std::string(info.name)] = value;
}

template <class Value>
void named_choice(const char* label, Value& value, std::span<const Value> values, std::string_view (*name)(Value)) {
    if (!ImGui::BeginCombo(label, std::string(name(value)).c_str())) return;
    for (const Value each : values) {
        if (ImGui::Selectable(std::string(name(each)).c_str(), each == value)) value = each;
    }
    ImGui::EndCombo();
}

std::string labelled(std::string_view kind, std::size_t index, const std::string& name) {
    return fmt::format("{} {}{}{}##{}", kind, index, name.empty() ? "" : ": ", one_line(name), index);
}

/// A node of the tree, which is open from the start where there is only one.
bool list_entry(std::string_view kind, std::size_t index, const std::string& name, std::size_t count) {
    return ImGui::TreeNodeEx(labelled(kind, index, name).c_str(), count == 1 ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

void edit_direction(glm::vec3& direction) {
    float elevation = glm::degrees(std::asin(std::clamp(-direction.y, -1.0f, 1.0f)));
    float azimuth = glm::degrees(std::atan2(-direction.x, -direction.z));
    bool changed = drag("from azimuth", azimuth, 0.5f, -180.0f, 180.0f, "%.1f deg");
    changed |= drag("from elevation", elevation, 0.5f, -90.0f, 90.0f, "%.1f deg");
    if (!changed) return;
    const float a = glm::radians(azimuth), e = glm::radians(elevation);
    direction = -glm::vec3(std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a));
}

void edit_material(const Material& material, MaterialLook& look, float radius) {
    ImGui::ColorEdit3("colour", &look.base_color.x, ImGuiColorEditFlags_Float);
    drag("roughness", look.roughness, 0.005f, 0.0f, 1.0f);
    if (!material.transmissive()) return;
    drag("index", look.ior, 0.005f, 1.0f, 4.0f);
    drag("dispersion", look.dispersion, 0.005f, 0.0f, 10.0f);
    ImGui::ColorEdit3("absorption", &look.attenuation_color.x, ImGuiColorEditFlags_Float);
    bool absorbs = std::isfinite(look.attenuation_distance);
    if (ImGui::Checkbox("absorbs", &absorbs))
        look.attenuation_distance = absorbs ? radius : std::numeric_limits<float>::infinity();
    if (absorbs) drag("distance, m", look.attenuation_distance, 0.005f * radius, 1e-4f * radius, 1e4f * radius, "%.4g");
}

}  // namespace

void technique_section(Look& look, const Renderer& renderer) {
    if (!ImGui::CollapsingHeader("Technique", ImGuiTreeNodeFlags_DefaultOpen)) return;
    technique_combo("technique", look.technique, renderer, false);
    technique_combo("right side", look.other, renderer, true);
    int samples = int(look.samples);
    if (ImGui::DragInt("samples", &samples, 0.25f, 1, 4096, "%d", ImGuiSliderFlags_AlwaysClamp))
        look.samples = std::uint32_t(samples);
    const TechniqueChoice chosen = renderer.choose(look.technique);
    if (chosen.technique->name != look.technique)
        ImGui::TextDisabled("%s is %s on this device", look.technique.c_str(),
                            std::string(chosen.technique->name).c_str());
    if (chosen.technique->parameters.empty()) return;
    if (!ImGui::TreeNode("parameters")) return;
    for (const ParameterInfo& info : chosen.technique->parameters)
        parameter_widget(info, chosen.parameters, look.parameters);
    ImGui::TreePop();
}

void camera_section(Document& document) {
    if (!ImGui::CollapsingHeader("Camera")) return;
    Look& look = document.look;
    if (ImGui::BeginCombo("camera", look.file_camera.empty() ? "orbit" : look.file_camera.c_str())) {
        if (ImGui::Selectable("orbit", look.file_camera.empty())) look.file_camera.clear();
        for (const Camera& camera : document.scene().cameras) {
            if (!ImGui::Selectable(camera.name.c_str(), camera.name == look.file_camera)) continue;
            look.file_camera = camera.name;
            look.camera = orbit_from_camera(camera, document.bounds());
        }
        ImGui::EndCombo();
    }
    if (!look.file_camera.empty()) return;
    drag("azimuth", look.camera.azimuth_deg, 0.5f, -180.0f, 180.0f, "%.1f deg");
    drag("elevation", look.camera.elevation_deg, 0.5f, -90.0f, 90.0f, "%.1f deg");
    drag("distance", look.camera.distance, 0.02f, 0.01f, 100.0f, "%.2f radii");
    drag("field of view", look.camera.fov_deg, 0.2f, 1.0f, 150.0f, "%.1f deg");
}

void animation_section(Document& document, bool& playing, float& speed) {
    if (document.animations().empty() || !ImGui::CollapsingHeader("Animation", ImGuiTreeNodeFlags_DefaultOpen)) return;
    Look& look = document.look;
    const auto& all = document.animations();
    if (ImGui::BeginCombo("animation", look.animation ? all[*look.animation].name.c_str() : "at rest")) {
        if (ImGui::Selectable("at rest", !look.animation)) look.animation.reset();
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (ImGui::Selectable(labelled("", i, all[i].name).c_str(), look.animation == i)) look.animation = i;
        }
        ImGui::EndCombo();
    }
    if (!look.animation) return;
    ImGui::Checkbox("play", &playing);
    float time = float(look.time_s);
    if (ImGui::SliderFloat("time", &time, 0.0f, float(all[*look.animation].duration_s), "%.2f s"))
        look.time_s = double(time);
    drag("speed", speed, 0.01f, 0.0f, 10.0f);
}

void material_section(Document& document) {
    if (!ImGui::CollapsingHeader("Materials")) return;
    const auto& materials = document.scene().materials;
    for (std::size_t i = 0; i < materials.size(); ++i) {
        if (!list_entry("material", i, materials[i].name, materials.size())) continue;
        edit_material(materials[i], document.look.materials[i], std::max(document.bounds().radius, 1e-6f));
        ImGui::TreePop();
    }
}

void light_section(Document& document) {
    if (!ImGui::CollapsingHeader("Light")) return;
    Look& look = document.look;
    constexpr std::array kTransports{LightTransport::kAutomatic, LightTransport::kEnvironment, LightTransport::kDirect,
                                     LightTransport::kFull};
    named_choice<LightTransport>("transport", look.transport, kTransports, &light_transport_name);
    bool tinted = look.shadows == Shadows::kTinted;
    if (ImGui::Checkbox("tinted shadows", &tinted)) look.shadows = tinted ? Shadows::kTinted : Shadows::kExact;
    const auto& lights = document.scene().lights;
    const float radius = std::max(document.bounds().radius, 1e-6f);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (!list_entry("light", i, lights[i].name, lights.size())) continue;
        LightLook& light = look.lights[i];
        ImGui::DragFloat3("intensity", &light.intensity.x, 0.02f, 0.0f, 1e6f, "%.3g", ImGuiSliderFlags_AlwaysClamp);
        if (lights[i].kind != Light::Kind::kDirectional)
            ImGui::DragFloat3("position, m", &light.position.x, 0.01f * radius, 0.0f, 0.0f, "%.4g");
        if (lights[i].kind != Light::Kind::kPoint) edit_direction(light.direction);
        if (lights[i].kind == Light::Kind::kDirectional) {
            float degrees = glm::degrees(light.size);
            if (drag("diameter", degrees, 0.01f, 0.0f, 179.0f, "%.2f deg")) light.size = glm::radians(degrees);
        } else {
            drag("radius, m", light.size, 0.002f * radius, 0.0f, radius, "%.4g");
        }
        ImGui::TreePop();
    }
}

void environment_section(Document& document, std::string& path, std::string& wish) {
    if (!ImGui::CollapsingHeader("Environment")) return;
    Look& look = document.look;
    if (ImGui::BeginCombo("light", look.environment.c_str())) {
        for (const char* name : {"studio", "checker", "sky", "uniform"}) {
            if (ImGui::Selectable(name, look.environment == name)) wish = name;
        }
        ImGui::EndCombo();
    }
    if (ImGui::InputText("file", &path, ImGuiInputTextFlags_EnterReturnsTrue)) wish = path;
    drag_double("rotation", look.environment_rotation_deg, 0.5f, -360.0, 360.0, "%.1f deg");
    drag_double("intensity##environment", look.environment_intensity, 0.01f, 0.0, 1000.0, "%.2f");
}

void display_section(Look& look) {
    if (!ImGui::CollapsingHeader("Display")) return;
    drag("exposure", look.exposure_ev, 0.02f, -20.0f, 20.0f, "%.2f EV");
    // Frames have neither krawczyk nor wavefronts.
    constexpr std::array kTonemaps{ToneMap::kNone, ToneMap::kReinhard, ToneMap::kAces, ToneMap::kNeutral};
    named_choice<ToneMap>("tone map", look.tonemap, kTonemaps, &tonemap_name);
    constexpr std::array kViews{View::kRadiance, View::kAnalysis};
    named_choice<View>("view", look.view, kViews, &view_name);
    if (ImGui::BeginCombo("overlay", look.overlay.empty() ? "none" : look.overlay.c_str())) {
        if (ImGui::Selectable("none", look.overlay.empty())) look.overlay.clear();
        for (const OverlayInfo& info : overlay_infos()) choice(look.overlay, info.name, info.legend);
        ImGui::EndCombo();
    }
    if (!look.overlay.empty()) ImGui::TextWrapped("%s", std::string(find_overlay(look.overlay).legend).c_str());
}

}  // namespace pellucid::viewer
