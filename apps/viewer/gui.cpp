#include "viewer/gui.h"

#include <imgui.h>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>

namespace pellucid::viewer {
namespace {

void check(VkResult result) {
    if (result < 0) throw DeviceError("Vulkan failed while the panels were drawn");
}

}  // namespace

Gui::Gui(Gpu& gpu, Window& window) : gpu_(gpu) {
    const vk::DescriptorPoolSize size{vk::DescriptorType::eCombinedImageSampler, 4};
    pool_ = gpu.device().createDescriptorPool({.flags = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
                                               .maxSets = 4,
                                               .poolSizeCount = 1,
                                               .pPoolSizes = &size});
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 4.0f;
    style.FrameRounding = 3.0f;
    style.AntiAliasedLinesUseTex = false;
    ImGui_ImplGlfw_InitForVulkan(window.handle(), true);
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = *gpu.instance();
    info.PhysicalDevice = *gpu.physical();
    info.Device = *gpu.device();
    info.QueueFamily = gpu.queue_family();
    info.Queue = gpu.queue();
    info.DescriptorPool = *pool_;
    info.MinImageCount = 3;
    info.ImageCount = std::max(3u, window.image_count());
    info.CheckVkResultFn = &check;
    ImGui_ImplVulkan_Init(&info, window.overlay_pass());
    gpu.run([](const vk::raii::CommandBuffer& commands) { ImGui_ImplVulkan_CreateFontsTexture(*commands); });
    ImGui_ImplVulkan_DestroyFontUploadObjects();
}

Gui::~Gui() {
    gpu_.wait_idle();
    ImGui_ImplVulkan_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void Gui::begin_frame() {
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Gui::end_frame() { ImGui::Render(); }

void Gui::record(vk::CommandBuffer commands) { ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands); }

}  // namespace pellucid::viewer
