// A small engine that draws its own world, and lets Pellucid draw the glass in it. Device, commands, colour and depth
// images belong to the engine. It has two frames in flight and no window.
//   engine [FRAMES [FILE.ppm [DICE]]]
#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#include <vulkan/vulkan_raii.hpp>

#include <pellucid/pellucid.h>
#include <pellucid/vulkan.h>

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace {

constexpr std::uint32_t kWidth = 640, kHeight = 360, kInFlight = 2;
constexpr float kFov = 0.7f, kNear = 0.1f, kFar = 50.0f;
constexpr auto kColorFormat = vk::Format::eR16G16B16A16Sfloat, kDepthFormat = vk::Format::eD32Sfloat;

constexpr std::uint32_t kVertexCode[] = {
#include "floor.vert.inc"
};
constexpr std::uint32_t kFragmentCode[] = {
#include "floor.frag.inc"
};

vk::raii::DeviceMemory allocate(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device,
                                vk::MemoryRequirements needs, vk::MemoryPropertyFlags wanted) {
    const auto types = physical.getMemoryProperties();
    std::uint32_t type = 0;
    while (!(needs.memoryTypeBits >> type & 1) || (types.memoryTypes[type].propertyFlags & wanted) != wanted) ++type;
    return device.allocateMemory({.allocationSize = needs.size, .memoryTypeIndex = type});
}

struct Image {
    Image(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device, vk::Format format,
          vk::ImageUsageFlags usage)
        : image(device.createImage({.imageType = vk::ImageType::e2D,
                                    .format = format,
                                    .extent = {kWidth, kHeight, 1},
                                    .mipLevels = 1,
                                    .arrayLayers = 1,
                                    .usage = usage})),
          memory(allocate(physical, device, image.getMemoryRequirements(), vk::MemoryPropertyFlagBits::eDeviceLocal)),
          aspect(format == kDepthFormat ? vk::ImageAspectFlagBits::eDepth : vk::ImageAspectFlagBits::eColor) {
        image.bindMemory(*memory, 0);
        if (usage & (vk::ImageUsageFlagBits::eColorAttachment | vk::ImageUsageFlagBits::eDepthStencilAttachment))
            view = device.createImageView({.image = *image,
                                           .viewType = vk::ImageViewType::e2D,
                                           .format = format,
                                           .subresourceRange = {aspect, 0, 1, 0, 1}});
    }
    void change(const vk::raii::CommandBuffer& commands, vk::ImageLayout from, vk::ImageLayout to) const {
        const vk::ImageMemoryBarrier2 barrier{
            .srcStageMask = vk::PipelineStageFlagBits2::eAllCommands,
            .srcAccessMask = vk::AccessFlagBits2::eMemoryWrite,
            .dstStageMask = vk::PipelineStageFlagBits2::eAllCommands,
            .dstAccessMask = vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite,
            .oldLayout = from,
            .newLayout = to,
            .image = *image,
            .subresourceRange = {aspect, 0, 1, 0, 1}};
        commands.pipelineBarrier2({.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier});
    }
    vk::raii::Image image;
    vk::raii::DeviceMemory memory;
    vk::ImageAspectFlags aspect;
    vk::raii::ImageView view = nullptr;
};

/// Boxes without vertex buffers (floor.vert).
struct World {
    explicit World(const vk::raii::Device& device) {
        const vk::PushConstantRange push{vk::ShaderStageFlagBits::eVertex, 0, sizeof(glm::mat4)};
        layout = device.createPipelineLayout({.pushConstantRangeCount = 1, .pPushConstantRanges = &push});
        const auto vertex = device.createShaderModule({.codeSize = sizeof(kVertexCode), .pCode = kVertexCode});
        const auto fragment = device.createShaderModule({.codeSize = sizeof(kFragmentCode), .pCode = kFragmentCode});
        const vk::PipelineShaderStageCreateInfo stages[] = {
            {.stage = vk::ShaderStageFlagBits::eVertex, .module = *vertex, .pName = "main"},
            {.stage = vk::ShaderStageFlagBits::eFragment, .module = *fragment, .pName = "main"}};
        const vk::PipelineVertexInputStateCreateInfo no_vertices{};
        const vk::PipelineInputAssemblyStateCreateInfo triangles{.topology = vk::PrimitiveTopology::eTriangleList};
        const vk::Viewport viewport{0.0f, 0.0f, float(kWidth), float(kHeight), 0.0f, 1.0f};
        const vk::Rect2D all{{0, 0}, {kWidth, kHeight}};
        const vk::PipelineViewportStateCreateInfo view{
            .viewportCount = 1, .pViewports = &viewport, .scissorCount = 1, .pScissors = &all};
        const vk::PipelineRasterizationStateCreateInfo raster{.lineWidth = 1.0f};
        const vk::PipelineMultisampleStateCreateInfo one_sample{.rasterizationSamples = vk::SampleCountFlagBits::e1};
        const vk::PipelineDepthStencilStateCreateInfo depth{
            .depthTestEnable = true, .depthWriteEnable = true, .depthCompareOp = vk::CompareOp::eLess};
        using Channel = vk::ColorComponentFlagBits;
        const vk::PipelineColorBlendAttachmentState replace{.colorWriteMask =
                                                                Channel::eR | Channel::eG | Channel::eB | Channel::eA};
        const vk::PipelineColorBlendStateCreateInfo blend{.attachmentCount = 1, .pAttachments = &replace};
        const vk::PipelineRenderingCreateInfo formats{
            .colorAttachmentCount = 1, .pColorAttachmentFormats = &kColorFormat, .depthAttachmentFormat = kDepthFormat};
        pipeline = device.createGraphicsPipeline(nullptr, {.pNext = &formats,
                                                           .stageCount = 2,
                                                           .pStages = stages,
                                                           .pVertexInputState = &no_vertices,
                                                           .pInputAssemblyState = &triangles,
                                                           .pViewportState = &view,
                                                           .pRasterizationState = &raster,
                                                           .pMultisampleState = &one_sample,
                                                           .pDepthStencilState = &depth,
                                                           .pColorBlendState = &blend,
                                                           .layout = *layout});
    }
    void draw(const vk::raii::CommandBuffer& commands, const Image& color, const Image& depth,
              const glm::mat4& clip_from_world) const {
        using Layout = vk::ImageLayout;
        color.change(commands, Layout::eUndefined, Layout::eColorAttachmentOptimal);
        depth.change(commands, Layout::eUndefined, Layout::eDepthAttachmentOptimal);
        const vk::RenderingAttachmentInfo to_color{
            .imageView = *color.view,
            .imageLayout = Layout::eColorAttachmentOptimal,
            .loadOp = vk::AttachmentLoadOp::eClear,
            .clearValue = vk::ClearColorValue(std::array{0.35f, 0.55f, 0.9f, 1.0f})};  // the engine's sky
        const vk::RenderingAttachmentInfo to_depth{.imageView = *depth.view,
                                                   .imageLayout = Layout::eDepthAttachmentOptimal,
                                                   .loadOp = vk::AttachmentLoadOp::eClear,
                                                   .clearValue = vk::ClearDepthStencilValue{1.0f, 0}};
        commands.beginRendering({.renderArea = {{0, 0}, {kWidth, kHeight}},
                                 .layerCount = 1,
                                 .colorAttachmentCount = 1,
                                 .pColorAttachments = &to_color,
                                 .pDepthAttachment = &to_depth});
        commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *pipeline);
        commands.pushConstants<glm::mat4>(*layout, vk::ShaderStageFlagBits::eVertex, 0, clip_from_world);
        commands.draw(5 * 36, 1, 0, 0);
        commands.endRendering();
        color.change(commands, Layout::eColorAttachmentOptimal, Layout::eTransferSrcOptimal);
        depth.change(commands, Layout::eDepthAttachmentOptimal, Layout::eTransferSrcOptimal);
    }
    vk::raii::PipelineLayout layout = nullptr;
    vk::raii::Pipeline pipeline = nullptr;
};

void run(int frame_count, const char* file, int dice) {
    // The engine's instance and device, with the features that Pellucid needs.
    const vk::raii::Context context;
    const vk::ApplicationInfo application{.apiVersion = VK_API_VERSION_1_3};
    const vk::raii::Instance instance(context, {.pApplicationInfo = &application});
    const vk::raii::PhysicalDevice physical = std::move(vk::raii::PhysicalDevices(instance).front());
    const pellucid::vulkan::DeviceFeatures wanted(*instance, *physical);
    const float priority = 1.0f;
    const vk::DeviceQueueCreateInfo queue_info{
        .queueFamilyIndex = wanted.queue_family(), .queueCount = 1, .pQueuePriorities = &priority};
    const vk::raii::Device device(physical, {.pNext = wanted.features(),
                                             .queueCreateInfoCount = 1,
                                             .pQueueCreateInfos = &queue_info,
                                             .enabledExtensionCount = std::uint32_t(wanted.extensions().size()),
                                             .ppEnabledExtensionNames = wanted.extensions().data()});
    const vk::raii::Queue queue = device.getQueue(wanted.queue_family(), 0);

    using Usage = vk::ImageUsageFlagBits;
    const Image color(physical, device, kColorFormat, Usage::eColorAttachment | Usage::eTransferSrc);
    const Image depth(physical, device, kDepthFormat, Usage::eDepthStencilAttachment | Usage::eTransferSrc);
    const Image output(physical, device, vk::Format::eR8G8B8A8Unorm, Usage::eTransferDst | Usage::eTransferSrc);
    const auto pixels =
        device.createBuffer({.size = 4 * kWidth * kHeight, .usage = vk::BufferUsageFlagBits::eTransferDst});
    const auto pixel_memory =
        allocate(physical, device, pixels.getMemoryRequirements(),
                 vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent);
    pixels.bindMemory(*pixel_memory, 0);
    const World world(device);
    const auto pool = device.createCommandPool(
        {.flags = vk::CommandPoolCreateFlagBits::eResetCommandBuffer, .queueFamilyIndex = wanted.queue_family()});
    const auto commands = device.allocateCommandBuffers({.commandPool = *pool, .commandBufferCount = kInFlight});
    std::vector<vk::raii::Fence> fences;
    for (std::uint32_t i = 0; i < kInFlight; ++i)
        fences.push_back(device.createFence({.flags = vk::FenceCreateFlagBits::eSignaled}));

    // The glass.
    pellucid::Renderer renderer(pellucid::vulkan::LentDevice{
        *instance, *physical, *device, *queue, wanted.queue_family(), wanted.features(), wanted.extensions()});
    pellucid::Scene scene = pellucid::load_scene("shape:goblet");
    scene.meshes.push_back(pellucid::load_scene("shape:cube").meshes.front());
    for (int i = 0; i < dice; ++i) {  // in rows of eight
        const glm::mat4 at =
            glm::translate(glm::mat4(1.0f), {0.45f * float(i % 8) - 1.6f, -0.9f, 0.45f * float(i / 8) - 1.6f});
        scene.objects.push_back({.name = "die", .mesh = 1, .world_from_object = glm::scale(at, glm::vec3(0.09f))});
    }
    renderer.set_scene(scene);
    renderer.set_environment(pellucid::load_environment("sky"));
    pellucid::vulkan::Frames frames(renderer, kInFlight);
    pellucid::RenderSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.technique = "balanced";
    const pellucid::vulkan::Target target{.image = *output.image,
                                          .format = VK_FORMAT_R8G8B8A8_UNORM,
                                          .layout_after = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    glm::mat4 clip_from_view = glm::perspectiveRH_ZO(kFov, float(kWidth) / kHeight, kNear, kFar);
    clip_from_view[1][1] *= -1.0f;  // Vulkan's y axis points down
    pellucid::vulkan::Background background{.color = *color.image,
                                            .depth = *depth.image,
                                            .zz = clip_from_view[2][2],
                                            .zw = clip_from_view[3][2],
                                            .wz = clip_from_view[2][3],
                                            .ww = clip_from_view[3][3]};

    pellucid::vulkan::Ticket tickets[kInFlight]{};  // 0: no ticket
    std::vector<double> times_ms;
    const auto finish = [&](std::uint32_t slot) {
        while (device.waitForFences(*fences[slot], true, ~0ull) == vk::Result::eTimeout) {
        }
        if (tickets[slot] == 0) return;
        const auto report = frames.read(tickets[slot]).value();
        for (const std::string& what : report.overflows) std::printf("no room yet: %s\n", what.c_str());
    };
    for (int frame = 0; frame < frame_count; ++frame) {
        const std::uint32_t slot = std::uint32_t(frame) % kInFlight;
        finish(slot);
        device.resetFences(*fences[slot]);
        pellucid::Camera camera;
        const float angle = 0.6f + 0.01f * float(frame);
        camera.world_from_view = glm::inverse(glm::lookAt(
            glm::vec3(5.0f * std::sin(angle), 1.5f, 5.0f * std::cos(angle)), glm::vec3(0.0f, -0.2f, 0.0f), {0, 1, 0}));
        camera.vertical_fov = kFov;
        camera.near_plane = kNear;
        camera.far_plane = kFar;
        renderer.set_camera(camera);
        commands[slot].begin({});
        world.draw(commands[slot], color, depth, clip_from_view * glm::inverse(camera.world_from_view));
        const auto start = std::chrono::steady_clock::now();
        tickets[slot] = frames.record(*commands[slot], settings, target, &background);
        const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
        times_ms.push_back(took.count());
        const vk::BufferImageCopy all{.imageSubresource = {vk::ImageAspectFlagBits::eColor, 0, 0, 1},
                                      .imageExtent = {kWidth, kHeight, 1}};
        commands[slot].copyImageToBuffer(*output.image, vk::ImageLayout::eTransferSrcOptimal, *pixels, all);
        commands[slot].end();
        const vk::CommandBuffer handle = *commands[slot];
        queue.submit(vk::SubmitInfo{.commandBufferCount = 1, .pCommandBuffers = &handle}, *fences[slot]);
    }
    for (int last = frame_count; last < frame_count + int(kInFlight); ++last) finish(std::uint32_t(last) % kInFlight);
    std::nth_element(times_ms.begin(), times_ms.begin() + frame_count / 2, times_ms.end());
    std::printf("%d frames of %ux%u; recording one took %.2f ms (median)\n", frame_count, kWidth, kHeight,
                times_ms[std::size_t(frame_count / 2)]);

    std::ofstream picture(file, std::ios::binary);
    picture << "P6 " << kWidth << ' ' << kHeight << " 255\n";
    const auto* bytes = static_cast<const char*>(pixel_memory.mapMemory(0, VK_WHOLE_SIZE));
    for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) picture.write(bytes + 4 * i, 3);
}

}  // namespace

int main(int count, char** arguments) {
    try {
        run(count > 1 ? std::max(std::atoi(arguments[1]), 1) : 30, count > 2 ? arguments[2] : "engine.ppm",
            count > 3 ? std::atoi(arguments[3]) : 0);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "engine: %s\n", error.what());
        return 1;
    }
}
