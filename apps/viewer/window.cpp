#include "viewer/window.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace pellucid::viewer {
namespace {

constexpr std::size_t kFramesInFlight = 2;

std::string glfw_error() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? text : "unknown";
}

Window& window_of(GLFWwindow* handle) { return *static_cast<Window*>(glfwGetWindowUserPointer(handle)); }

}  // namespace

Glfw::Glfw() {
    if (!glfwInit()) throw Error(fmt::format("no window can be opened: {} (is there a display?)", glfw_error()));
    if (!glfwVulkanSupported()) {
        glfwTerminate();
        throw Error("no window can be opened: GLFW finds no Vulkan");
    }
}

Glfw::~Glfw() { glfwTerminate(); }

Window::Window(Gpu& gpu, const std::string& title, std::uint32_t width, std::uint32_t height) : gpu_(gpu) {
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window_ = glfwCreateWindow(int(width), int(height), title.c_str(), nullptr, nullptr);
    if (window_ == nullptr) throw Error(fmt::format("no window can be opened: {}", glfw_error()));
    glfwSetWindowUserPointer(window_, this);
    // Dear ImGui, initialised later, chains to these callbacks.
    glfwSetDropCallback(window_, [](GLFWwindow* handle, int count, const char** paths) {
        Window& self = window_of(handle);
        self.dropped_.insert(self.dropped_.end(), paths, paths + count);
        self.events_ = true;
    });
    glfwSetFramebufferSizeCallback(window_,
                                   [](GLFWwindow* h, int, int) { window_of(h).stale_ = window_of(h).events_ = true; });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* h) { window_of(h).events_ = true; });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* h, double, double) { window_of(h).events_ = true; });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* h, int, int, int) { window_of(h).events_ = true; });
    glfwSetScrollCallback(window_, [](GLFWwindow* h, double, double) { window_of(h).events_ = true; });
    glfwSetKeyCallback(window_, [](GLFWwindow* h, int, int, int, int) { window_of(h).events_ = true; });
    glfwSetCharCallback(window_, [](GLFWwindow* h, unsigned) { window_of(h).events_ = true; });

    VkSurfaceKHR surface = VK_NULL_HANDLE;
    if (glfwCreateWindowSurface(*gpu.instance(), window_, nullptr, &surface) != VK_SUCCESS)
        throw DeviceError(fmt::format("no surface for the window: {}", glfw_error()));
    surface_ = vk::raii::SurfaceKHR(gpu.instance(), surface);
    const auto formats = gpu.physical().getSurfaceFormatsKHR(*surface_);
    const auto known = std::find_if(formats.begin(), formats.end(), [](const vk::SurfaceFormatKHR& each) {
        return each.format == vk::Format::eB8G8R8A8Unorm || each.format == vk::Format::eR8G8B8A8Unorm;
    });
    if (known == formats.end()) throw DeviceError("the window has no format of 8 bits a channel");
    format_ = known->format;
    make_overlay_pass();
    make_frames();
    make_swapchain();
}

Window::~Window() {
    gpu_.wait_idle();
    images_.clear();
    swapchain_ = nullptr;
    surface_ = nullptr;
    glfwDestroyWindow(window_);
}

bool Window::should_close() const { return glfwWindowShouldClose(window_); }
void Window::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }
void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }
void Window::resize(std::uint32_t width, std::uint32_t height) { glfwSetWindowSize(window_, int(width), int(height)); }
void Window::minimize() { glfwIconifyWindow(window_); }
void Window::restore() { glfwRestoreWindow(window_); }

bool Window::handle_events(double wait_s) {
    events_ = false;
    if (wait_s > 0.0)
        glfwWaitEventsTimeout(wait_s);
    else
        glfwPollEvents();
    return events_;
}

vk::Extent2D Window::extent() const {
    if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED)) return {0, 0};
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return {std::uint32_t(width), std::uint32_t(height)};
}

std::vector<std::filesystem::path> Window::take_dropped() { return std::exchange(dropped_, {}); }

void Window::make_overlay_pass() {
    const vk::AttachmentDescription color{.format = format_,
                                          .loadOp = vk::AttachmentLoadOp::eLoad,
                                          .storeOp = vk::AttachmentStoreOp::eStore,
                                          .stencilLoadOp = vk::AttachmentLoadOp::eDontCare,
                                          .stencilStoreOp = vk::AttachmentStoreOp::eDontCare,
                                          .initialLayout = vk::ImageLayout::eColorAttachmentOptimal,
                                          .finalLayout = vk::ImageLayout::eColorAttachmentOptimal};
    const vk::AttachmentReference reference{0, vk::ImageLayout::eColorAttachmentOptimal};
    const vk::SubpassDescription subpass{.colorAttachmentCount = 1, .pColorAttachments = &reference};
    overlay_pass_ = gpu_.device().createRenderPass(
        {.attachmentCount = 1, .pAttachments = &color, .subpassCount = 1, .pSubpasses = &subpass});
}

void Window::make_frames() {
    pool_ = gpu_.device().createCommandPool(
        {.flags = vk::CommandPoolCreateFlagBits::eResetCommandBuffer, .queueFamilyIndex = gpu_.queue_family()});
    vk::raii::CommandBuffers buffers(gpu_.device(),
                                     {.commandPool = *pool_, .commandBufferCount = std::uint32_t(kFramesInFlight)});
    for (vk::raii::CommandBuffer& buffer : buffers) {
        frames_.push_back({std::move(buffer), gpu_.device().createFence({.flags = vk::FenceCreateFlagBits::eSignaled}),
                           gpu_.device().createSemaphore({})});
    }
}

/// Returns false if the window has no pixels.
bool Window::make_swapchain() {
    gpu_.wait_idle();
    const vk::SurfaceCapabilitiesKHR can = gpu_.physical().getSurfaceCapabilitiesKHR(*surface_);
    vk::Extent2D size = can.currentExtent;
    if (size.width == UINT32_MAX) {
        size = extent();
        size.width = std::clamp(size.width, can.minImageExtent.width, can.maxImageExtent.width);
        size.height = std::clamp(size.height, can.minImageExtent.height, can.maxImageExtent.height);
    }
    if (size.width == 0 || size.height == 0) return false;
    const std::uint32_t wanted = std::max(3u, can.minImageCount);
    using Usage = vk::ImageUsageFlagBits;
    vk::raii::SwapchainKHR swapchain = gpu_.device().createSwapchainKHR(
        {.surface = *surface_,
         .minImageCount = can.maxImageCount > 0 ? std::min(wanted, can.maxImageCount) : wanted,
         .imageFormat = format_,
         .imageColorSpace = vk::ColorSpaceKHR::eSrgbNonlinear,
         .imageExtent = size,
         .imageArrayLayers = 1,
         .imageUsage = Usage::eColorAttachment | Usage::eTransferDst | Usage::eTransferSrc,
         .preTransform = can.currentTransform,
         .compositeAlpha = vk::CompositeAlphaFlagBitsKHR::eOpaque,
         .presentMode = vk::PresentModeKHR::eFifo,
         .clipped = true,
         .oldSwapchain = *swapchain_});
    images_.clear();
    swapchain_ = std::move(swapchain);
    extent_ = size;
    for (const VkImage each : swapchain_.getImages()) {
        SwapImage image{.image = each};
        image.view = gpu_.device().createImageView({.image = each,
                                                    .viewType = vk::ImageViewType::e2D,
                                                    .format = format_,
                                                    .subresourceRange = {vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1}});
        image.framebuffer = gpu_.device().createFramebuffer({.renderPass = *overlay_pass_,
                                                             .attachmentCount = 1,
                                                             .pAttachments = &*image.view,
                                                             .width = size.width,
                                                             .height = size.height,
                                                             .layers = 1});
        image.drawn = gpu_.device().createSemaphore({});
        images_.push_back(std::move(image));
    }
    stale_ = false;
    return true;
}

void Window::wait_for(const Frame& frame) {
    if (gpu_.device().waitForFences(*frame.done, true, UINT64_MAX) != vk::Result::eSuccess)
        throw DeviceError("the window's frame did not finish");
}

void Window::wait_for_reads() {
    for (const Frame& frame : frames_) wait_for(frame);
}

void Window::draw(std::span<const ShownImage> images, const std::function<void(vk::CommandBuffer)>& overlay,
                  Image* capture) {
    const vk::Extent2D now = extent();
    if (now.width == 0 || now.height == 0) return;
    const Frame& frame = frames_[next_frame_];
    wait_for(frame);
    std::uint32_t index = 0;
    for (int attempt = 0;; ++attempt) {
        if (attempt == 4) return;  // the window changes faster than it can be drawn; the next frame follows soon
        if ((stale_ || now != extent_) && !make_swapchain()) return;
        try {
            index = swapchain_.acquireNextImage(UINT64_MAX, *frame.acquired).second;
            break;
        } catch (const vk::OutOfDateKHRError&) {
            stale_ = true;
        }
    }
    std::optional<HostBuffer> captured;
    if (capture)
        captured.emplace(gpu_, vk::DeviceSize(extent_.width) * extent_.height * 4,
                         vk::BufferUsageFlagBits::eTransferDst);
    const SwapImage& to = images_[index];
    record(frame, to, images, overlay, captured ? &*captured : nullptr);

    gpu_.device().resetFences(*frame.done);
    const vk::PipelineStageFlags stage = vk::PipelineStageFlagBits::eAllCommands;
    const vk::SubmitInfo submit{.waitSemaphoreCount = 1,
                                .pWaitSemaphores = &*frame.acquired,
                                .pWaitDstStageMask = &stage,
                                .commandBufferCount = 1,
                                .pCommandBuffers = &*frame.commands,
                                .signalSemaphoreCount = 1,
                                .pSignalSemaphores = &*to.drawn};
    const vk::PresentInfoKHR present{.waitSemaphoreCount = 1,
                                     .pWaitSemaphores = &*to.drawn,
                                     .swapchainCount = 1,
                                     .pSwapchains = &*swapchain_,
                                     .pImageIndices = &index};
    try {
        const std::scoped_lock lock(gpu_.queue_mutex());
        gpu_.queue().submit(submit, *frame.done);
        if (gpu_.queue().presentKHR(present) == vk::Result::eSuboptimalKHR) stale_ = true;
    } catch (const vk::OutOfDateKHRError&) {
        stale_ = true;
    }
    next_frame_ = (next_frame_ + 1) % frames_.size();
    if (!capture) return;
    wait_for(frame);
    *capture = image_of(captured->mapped, format_, extent_);
}

void Window::record(const Frame& frame, const SwapImage& to, std::span<const ShownImage> images,
                    const std::function<void(vk::CommandBuffer)>& overlay, const HostBuffer* capture) {
    using Layout = vk::ImageLayout;
    constexpr vk::ImageSubresourceLayers kLayers{vk::ImageAspectFlagBits::eColor, 0, 0, 1};
    const vk::raii::CommandBuffer& commands = frame.commands;
    commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    change_layout(commands, to.image, Layout::eUndefined, Layout::eTransferDstOptimal);
    commands.clearColorImage(to.image, Layout::eTransferDstOptimal, vk::ClearColorValue{},
                             vk::ImageSubresourceRange{vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1});
    for (const ShownImage& each : images) {
        // Wait for the drawing of the image, and for the previous image, which may lie below it.
        change_layout(commands, each.image, Layout::eTransferSrcOptimal, Layout::eTransferSrcOptimal);
        change_layout(commands, to.image, Layout::eTransferDstOptimal, Layout::eTransferDstOptimal);
        const auto corners = [](const vk::Rect2D& r) {
            return std::array{
                vk::Offset3D{r.offset.x, r.offset.y, 0},
                vk::Offset3D{r.offset.x + std::int32_t(r.extent.width), r.offset.y + std::int32_t(r.extent.height), 1}};
        };
        const std::array to_corners = corners(each.where);
        // During a resize, images may be larger than the window.
        if (to_corners[1].x > std::int32_t(extent_.width) || to_corners[1].y > std::int32_t(extent_.height)) continue;
        if (each.from.extent.width == 0 || each.from.extent.height == 0) continue;
        if (each.where.extent.width == 0 || each.where.extent.height == 0) continue;
        const vk::ImageBlit blit{.srcSubresource = kLayers,
                                 .srcOffsets = corners(each.from),
                                 .dstSubresource = kLayers,
                                 .dstOffsets = to_corners};
        const bool same = each.from.extent == each.where.extent;
        commands.blitImage(each.image, Layout::eTransferSrcOptimal, to.image, Layout::eTransferDstOptimal, blit,
                           same ? vk::Filter::eNearest : vk::Filter::eLinear);
    }
    change_layout(commands, to.image, Layout::eTransferDstOptimal, Layout::eColorAttachmentOptimal);
    commands.beginRenderPass(
        {.renderPass = *overlay_pass_, .framebuffer = *to.framebuffer, .renderArea = {{0, 0}, extent_}},
        vk::SubpassContents::eInline);
    overlay(*commands);
    commands.endRenderPass();
    if (capture) {
        change_layout(commands, to.image, Layout::eColorAttachmentOptimal, Layout::eTransferSrcOptimal);
        const vk::BufferImageCopy copy{.imageSubresource = kLayers, .imageExtent = {extent_.width, extent_.height, 1}};
        commands.copyImageToBuffer(to.image, Layout::eTransferSrcOptimal, *capture->buffer, copy);
        const vk::MemoryBarrier2 barrier{.srcStageMask = vk::PipelineStageFlagBits2::eTransfer,
                                         .srcAccessMask = vk::AccessFlagBits2::eTransferWrite,
                                         .dstStageMask = vk::PipelineStageFlagBits2::eHost,
                                         .dstAccessMask = vk::AccessFlagBits2::eHostRead};
        commands.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &barrier});
        change_layout(commands, to.image, Layout::eTransferSrcOptimal, Layout::ePresentSrcKHR);
    } else {
        change_layout(commands, to.image, Layout::eColorAttachmentOptimal, Layout::ePresentSrcKHR);
    }
    commands.end();
}

}  // namespace pellucid::viewer
