#include "viewer/input.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace pellucid::viewer {
namespace {

constexpr float kDegreesAcross = 240.0f;  ///< degrees of orbit for a drag over the window's height
constexpr float kLookAcross = 90.0f;      ///< degrees of view rotation for a drag over the window's height
constexpr float kZoomStep = 1.15f;        ///< factor of one step of the wheel
constexpr float kRadiiPerSecond = 0.8f;   ///< flying speed
constexpr float kMostFlySeconds = 0.1f;   ///< longest time step of flying: the first frame follows a pause
constexpr float kDividerPixels = 6.0f;    ///< distance within which the divider can be dragged

/// The camera to move; a camera of the file becomes an orbit camera first.
OrbitCamera& moved_camera(Document& document) {
    Look& look = document.look;
    if (!look.file_camera.empty()) {
        look.camera = orbit_from_camera(camera_of(look, document.scene(), document.bounds()), document.bounds());
        look.file_camera.clear();
    }
    return look.camera;
}

bool pressed(int key, bool repeat = false) { return ImGui::IsKeyPressed(key, repeat); }

}  // namespace

void Input::handle(Document& document, Panels& panels, Wishes& wishes, std::optional<glm::ivec2>& inspect) {
    handle_mouse(document, inspect);
    flying_ = false;
    if (!ImGui::GetIO().WantTextInput) handle_keys(document, panels, wishes, inspect);
    dragging_ = ImGui::IsAnyMouseDown() || ImGui::IsAnyItemActive() || flying_;
}

void Input::handle_mouse(Document& document, std::optional<glm::ivec2>& inspect) {
    const ImGuiIO& io = ImGui::GetIO();
    Look& look = document.look;
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) divider_held_ = false;
    if (io.WantCaptureMouse && !divider_held_) return;
    const float height = std::max(io.DisplaySize.y, 1.0f), width = std::max(io.DisplaySize.x, 1.0f);
    const bool at_divider = !look.other.empty() && std::abs(io.MousePos.x - look.divider * width) <= kDividerPixels;
    if (at_divider || divider_held_) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (at_divider && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) divider_held_ = true;
    if (divider_held_) {
        look.divider = std::clamp(io.MousePos.x / width, 0.0f, 1.0f);
        return;
    }
    if (io.KeyCtrl) {
        if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) inspect = {int(io.MousePos.x), int(io.MousePos.y)};
        return;
    }
    if (io.MouseWheel != 0.0f) zoom(moved_camera(document), std::pow(kZoomStep, io.MouseWheel));
    const ImVec2 d = io.MouseDelta;
    if (d.x == 0.0f && d.y == 0.0f) return;
    const float right = d.x / height, down = d.y / height;
    const auto held = [](int button) { return ImGui::IsMouseDown(button) && !ImGui::IsMouseClicked(button); };
    if (held(ImGuiMouseButton_Middle) || (held(ImGuiMouseButton_Left) && io.KeyShift))
        pan(moved_camera(document), document.bounds(), right, down);
    else if (held(ImGuiMouseButton_Left))
        turn(moved_camera(document), -kDegreesAcross * right, kDegreesAcross * down);
    else if (held(ImGuiMouseButton_Right))
        look_around(moved_camera(document), document.bounds(), -kLookAcross * right, kLookAcross * down);
}

void Input::handle_keys(Document& document, Panels& panels, Wishes& wishes, std::optional<glm::ivec2>& inspect) {
    const ImGuiIO& io = ImGui::GetIO();
    Look& look = document.look;
    if (pressed(GLFW_KEY_F1)) panels.help = !panels.help;
    if (pressed(GLFW_KEY_TAB)) panels.visible = !panels.visible;
    if (pressed(GLFW_KEY_ESCAPE)) {
        wishes.cancel = true;
        panels.help = false;
        panels.clear_message();
        inspect = {-1, -1};
    }
    wishes.screenshot |= pressed(GLFW_KEY_F12);
    if (io.KeyCtrl) {
        wishes.undo |= pressed(GLFW_KEY_Z, true) && !io.KeyShift;
        wishes.redo |= pressed(GLFW_KEY_Y, true) || (pressed(GLFW_KEY_Z, true) && io.KeyShift);
        wishes.save |= pressed(GLFW_KEY_S);
        wishes.copy_command |= pressed(GLFW_KEY_C);
        wishes.close |= pressed(GLFW_KEY_Q);
        return;
    }
    if (pressed(GLFW_KEY_SPACE) && !document.animations().empty()) {
        panels.playing = !panels.playing;
        if (!look.animation) look.animation = 0;
    }
    if (pressed(GLFW_KEY_LEFT_BRACKET, true)) look.exposure_ev -= 0.25f;
    if (pressed(GLFW_KEY_RIGHT_BRACKET, true)) look.exposure_ev += 0.25f;
    if (pressed(GLFW_KEY_V)) {
        if (look.other.empty()) {
            look.other = last_other_;
        } else {
            last_other_ = look.other;
            look.other.clear();
        }
    }
    wishes.frame |= pressed(GLFW_KEY_F);
    const auto axis = [](int plus, int minus) {
        return float(ImGui::IsKeyDown(plus)) - float(ImGui::IsKeyDown(minus));
    };
    const glm::vec3 way(axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q), axis(GLFW_KEY_W, GLFW_KEY_S));
    flying_ = way != glm::vec3(0.0f);
    const float seconds = std::min(io.DeltaTime, kMostFlySeconds);
    if (flying_) fly(moved_camera(document), document.bounds(), kRadiiPerSecond * seconds * way);
}

}  // namespace pellucid::viewer
