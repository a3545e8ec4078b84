#include "viewer/panels.h"

#include "viewer/look_sections.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

namespace pellucid::viewer {
namespace {

constexpr float kMargin = 8.0f, kWidth = 310.0f, kLeastWidth = 200.0f, kHelpWidth = 480.0f;  ///< pixels
constexpr float kLeastScreen = 100.0f;  ///< pixels; smaller windows show no panels
constexpr double kMessageSeconds = 6.0;

void show_progress(const char* label, const PictureInfo& info) {
    if (info.samples_wanted > 1) {
        const float share = float(info.samples) / float(info.samples_wanted);
        const std::string text = fmt::format("{}{} of {} samples", label, info.samples, info.samples_wanted);
        ImGui::ProgressBar(share, ImVec2(-1, 0), text.c_str());
    } else {
        const std::string text = fmt::format("{}{:.0f}% size{}, {:.0f} ms", label, 100.0f * info.pace.scale,
                                             info.pace.coarse ? ", technique fast" : "", info.frame_ms);
        ImGui::ProgressBar(0.0f, ImVec2(-1, 0), text.c_str());
    }
}

void times_section(const Facts& facts) {
    if (!ImGui::CollapsingHeader("Times")) return;
    if (!facts.frame_times_ms->empty()) {
        const std::vector<float> times(facts.frame_times_ms->begin(), facts.frame_times_ms->end());
        const float most = *std::max_element(times.begin(), times.end());
        ImGui::PlotHistogram("##frames", times.data(), int(times.size()), 0,
                             fmt::format("frames, up to {:.0f} ms", most).c_str(), 0.0f, most, ImVec2(-1, 50));
    }
    double whole = 0.0;
    for (const PassTime& pass : facts.left->passes) whole += pass.time_ms;
    for (const PassTime& pass : facts.left->passes) {
        const std::string text = fmt::format("{} {:.2f} ms", pass.name, pass.time_ms);
        ImGui::ProgressBar(whole > 0.0 ? float(pass.time_ms / whole) : 0.0f, ImVec2(-1, 0), text.c_str());
    }
    if (facts.left->passes.empty()) ImGui::TextDisabled("no times of passes yet");
}

void ray_section(const Facts& facts) {
    if (!ImGui::CollapsingHeader("Ray of a pixel", facts.ray ? ImGuiTreeNodeFlags_DefaultOpen : 0)) return;
    if (facts.ray == nullptr) {
        ImGui::TextDisabled("Ctrl+click a pixel");
        return;
    }
    const InspectedRay& ray = *facts.ray;
    ImGui::Text("pixel %u, %u", ray.pixel.x, ray.pixel.y);
    int number = 0;
    for (const InspectedEvent& event : ray.events) {
        ImGui::BulletText("%d %s after %.4g m", ++number, event.reflected ? "reflected" : "refracted",
                          double(event.length));
    }
    ImGui::Text("ends on %s, %s", ray.ends_on.c_str(), std::string(status_name(ray.path.status)).c_str());
    ImGui::Text("inside %.4g m, transmittance %.3f", double(ray.path.length_inside), double(ray.path.transmittance.g));
}

void warnings_of(const PictureInfo& info) {
    ImGui::PushTextWrapPos(0.0f);
    for (const auto* lines : {&info.warnings, &info.overflows}) {
        for (const std::string& line : *lines) ImGui::TextColored(ImVec4(1.0f, 0.8f, 0.4f, 1.0f), "%s", line.c_str());
    }
    ImGui::PopTextWrapPos();
}

}  // namespace

const std::vector<KeyHelp>& key_help() {
    static const std::vector<KeyHelp> kKeys{
        {"Left drag", "orbit"},
        {"Middle drag, Shift+left drag", "pan"},
        {"Wheel", "zoom"},
        {"Right drag", "look around"},
        {"W A S D Q E", "fly: forward, left, back, right, down, up"},
        {"F", "frame the scene"},
        {"Ctrl+click", "the ray of a pixel"},
        {"Space", "play or stop the animation"},
        {"Tab", "panels on or off"},
        {"V", "divider on or off; drag it"},
        {"[ ]", "exposure down, up"},
        {"Ctrl+Z, Ctrl+Y", "undo, redo"},
        {"Ctrl+S", "save the image"},
        {"Ctrl+C", "copy the equal pellucid render command"},
        {"F12", "save what the window shows"},
        {"Esc", "cancel loading; no ray, no message"},
        {"Drag a number", "change it; Ctrl+click: type it"},
        {"F1", "these keys"},
        {"Ctrl+Q", "quit"},
    };
    return kKeys;
}

void Panels::say(const std::string& line, bool is_error) {
    message_ = one_line(line);
    message_is_error_ = is_error;
    message_until_s_ = ImGui::GetTime() + kMessageSeconds;
}

double Panels::seconds_to_change() const {
    if (message_.empty() || message_is_error_) return -1.0;
    return std::max(0.0, message_until_s_ - ImGui::GetTime());
}

/// Draws the panel at the left, with messages and keys beside it. In narrow windows messages are below the panel, and
/// keys replace it.
void Panels::draw(Document& document, const Facts& facts, Wishes& wishes) {
    if (!message_is_error_ && ImGui::GetTime() >= message_until_s_) message_.clear();
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    if (screen.x < kLeastScreen || screen.y < kLeastScreen) return;  // ImGui windows would shrink permanently
    const bool has_scene = document.scene_number() > 0, has_message = !message_.empty() || facts.loading;
    const bool wants_panel = visible && has_scene;
    const bool covers_left = wants_panel && !collapsed_;
    const bool fits_beside = !covers_left || screen.x - panel_right_ >= kLeastWidth + 2.0f * kMargin;
    const bool has_panel = wants_panel && (fits_beside || !help);
    const float whole = screen.x - 2.0f * kMargin,
                above_message = screen.y - 2.0f * kMargin - (has_message ? message_height_ + kMargin : 0.0f);
    if (has_panel) {
        const float height = std::max(1.0f, fits_beside ? screen.y - 2.0f * kMargin : above_message);
        ImGui::SetNextWindowPos(ImVec2(kMargin, kMargin));
        ImGui::SetNextWindowSize(ImVec2(kWidth, height), ImGuiCond_FirstUseEver);
        ImGui::SetNextWindowSizeConstraints(ImVec2(std::min(kLeastWidth, whole), height), ImVec2(whole, height));
        draw_panel(document, facts, wishes);
    }
    const Strip strip{covers_left && fits_beside ? panel_right_ + kMargin : kMargin, screen.x - kMargin};
    if (help) draw_help(strip, above_message);
    if (has_message) draw_message(strip, has_scene, facts.loading, wishes);
}

void Panels::draw_panel(Document& document, const Facts& facts, Wishes& wishes) {
    ImGui::SetNextWindowBgAlpha(0.85f);
    const bool open = ImGui::Begin("Pellucid", nullptr, ImGuiWindowFlags_NoMove);
    collapsed_ = !open;
    if (open) {
        panel_right_ = kMargin + ImGui::GetWindowWidth();
        ImGui::PushItemWidth(-110.0f);
        show_progress(facts.right ? "left: " : "", *facts.left);
        if (facts.right) show_progress("right: ", *facts.right);
        scene_section(document, wishes);
        technique_section(document.look, *facts.renderer);
        camera_section(document);
        animation_section(document, playing, speed);
        material_section(document);
        light_section(document);
        environment_section(document, environment_path_, wishes.environment);
        display_section(document.look);
        times_section(facts);
        ray_section(facts);
        warnings_of(*facts.left);
        ImGui::PopItemWidth();
    }
    ImGui::End();
}

void Panels::scene_section(Document& document, Wishes& wishes) {
    if (!ImGui::CollapsingHeader("Scene", ImGuiTreeNodeFlags_DefaultOpen)) return;
    ImGui::TextWrapped("%s", document.scene().source.c_str());
    ImGui::TextDisabled("objects: %zu, triangles: %llu", document.scene().objects.size(),
                        static_cast<unsigned long long>(document.scene().triangle_count()));
    if (ImGui::InputText("open", &path_, ImGuiInputTextFlags_EnterReturnsTrue)) wishes.open = path_;
    if (ImGui::BeginCombo("shape", "choose")) {
        for (const ShapeInfo& shape : shape_infos()) {
            if (ImGui::Selectable(std::string(shape.name).c_str())) wishes.open = fmt::format("shape:{}", shape.name);
        }
        ImGui::EndCombo();
    }
    wishes.save |= ImGui::Button("Save image");
    ImGui::SameLine();
    wishes.copy_command |= ImGui::Button("Copy command");
    wishes.undo |= ImGui::Button("Undo");
    ImGui::SameLine();
    wishes.redo |= ImGui::Button("Redo");
    ImGui::SameLine();
    if (ImGui::Button("Keys (F1)")) help = !help;
}

void Panels::draw_message(Strip strip, bool has_scene, const std::optional<LoadingProgress>& loading, Wishes& wishes) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float width = strip.right - strip.left;
    ImGui::SetNextWindowPos(ImVec2(strip.left + 0.5f * width, screen.y - kMargin), ImGuiCond_Always,
                            ImVec2(0.5f, 1.0f));
    ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0), ImVec2(width, 0.5f * screen.y));
    ImGui::Begin("##message", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoSavedSettings);
    ImGui::PushTextWrapPos(width - 2.0f * ImGui::GetStyle().WindowPadding.x);
    if (loading) {
        ImGui::Text("Loading %s, %.0f s", one_line(loading->name).c_str(), loading->seconds);
        if (has_scene && ImGui::SmallButton("Cancel (Esc)")) wishes.cancel = true;
    }
    if (!message_.empty()) {
        const ImVec4 color = message_is_error_ ? ImVec4(1.0f, 0.5f, 0.4f, 1.0f) : ImVec4(0.8f, 0.9f, 1.0f, 1.0f);
        ImGui::TextColored(color, "%s", message_.c_str());
        if (message_is_error_ && ImGui::SmallButton("Close (Esc)")) message_.clear();
    }
    ImGui::PopTextWrapPos();
    message_height_ = ImGui::GetWindowHeight();
    ImGui::End();
}

void Panels::draw_help(Strip strip, float height) {
    const float width = std::min(kHelpWidth, strip.right - strip.left);
    ImGui::SetNextWindowPos(ImVec2(0.5f * (strip.left + strip.right), kMargin), ImGuiCond_Always, ImVec2(0.5f, 0.0f));
    ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, std::max(1.0f, height)));
    ImGui::Begin("Keys", &help,
                 ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
    if (ImGui::BeginTable("keys", 2)) {
        // An auto-sized window takes its width from its contents, so set it explicitly.
        const float text = width - 2.0f * ImGui::GetStyle().WindowPadding.x - ImGui::GetStyle().ScrollbarSize;
        ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthFixed, 0.42f * text);
        ImGui::TableSetupColumn("does", ImGuiTableColumnFlags_WidthFixed, 0.53f * text);
        for (const KeyHelp& each : key_help()) {
            ImGui::TableNextColumn();
            ImGui::TextWrapped("%s", each.keys);
            ImGui::TableNextColumn();
            ImGui::TextWrapped("%s", each.does);
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

}  // namespace pellucid::viewer
