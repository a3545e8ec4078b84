// Frames in commands and images of a program's own, against the pictures of render().
#include "gpu/lent_device_test.h"

#include <gmock/gmock.h>

#include <cstring>

namespace pellucid::test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using vulkan::FrameReport;
using vulkan::Frames;
using vulkan::Target;
using vulkan::Ticket;

vk::raii::DeviceMemory allocate(const vk::raii::Device& device, const vk::raii::PhysicalDevice& physical,
                                const vk::MemoryRequirements& needs, vk::MemoryPropertyFlags wanted) {
    const auto types = physical.getMemoryProperties();
    std::uint32_t type = 0;
    while ((needs.memoryTypeBits >> type & 1) == 0 || (types.memoryTypes[type].propertyFlags & wanted) != wanted)
        ++type;
    return {device, vk::MemoryAllocateInfo{.allocationSize = needs.size, .memoryTypeIndex = type}};
}

/// An image of the program's, and the host's copy of it.
class Screen {
public:
    Screen(const vk::raii::Device& device, const vk::raii::PhysicalDevice& physical, vk::Format format,
           vk::Extent2D extent)
        : device_(device), extent_(extent), format_(format), texel_(format == vk::Format::eR32G32B32A32Sfloat ? 16 : 4),
          image_(device, vk::ImageCreateInfo{.imageType = vk::ImageType::e2D,
                                             .format = format,
                                             .extent = {extent.width, extent.height, 1},
                                             .mipLevels = 1,
                                             .arrayLayers = 1,
                                             .usage = vk::ImageUsageFlagBits::eTransferDst |
                                                      vk::ImageUsageFlagBits::eTransferSrc}),
          buffer_(device, vk::BufferCreateInfo{.size = extent.width * extent.height * texel_,
                                               .usage = vk::BufferUsageFlagBits::eTransferDst}) {
        using Property = vk::MemoryPropertyFlagBits;
        image_memory_ = allocate(device, physical, image_.getMemoryRequirements(), {});
        buffer_memory_ = allocate(device, physical, buffer_.getMemoryRequirements(),
                                  Property::eHostVisible | Property::eHostCoherent);
        image_.bindMemory(*image_memory_, 0);
        buffer_.bindMemory(*buffer_memory_, 0);
        mapped_ = buffer_memory_.mapMemory(0, VK_WHOLE_SIZE);
    }
    Target target() const {
        return {.image = *image_, .format = VkFormat(format_), .layout_after = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    }
    void copy(const vk::raii::CommandBuffer& commands) const {
        const vk::BufferImageCopy region{
            .imageSubresource = {.aspectMask = vk::ImageAspectFlagBits::eColor, .layerCount = 1},
            .imageExtent = {extent_.width, extent_.height, 1}};
        commands.copyImageToBuffer(*image_, vk::ImageLayout::eTransferSrcOptimal, *buffer_, region);
        const vk::MemoryBarrier2 to_host{.srcStageMask = vk::PipelineStageFlagBits2::eCopy,
                                         .srcAccessMask = vk::AccessFlagBits2::eTransferWrite,
                                         .dstStageMask = vk::PipelineStageFlagBits2::eHost,
                                         .dstAccessMask = vk::AccessFlagBits2::eHostRead};
        commands.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &to_host});
    }
    std::vector<std::uint8_t> bytes() const {
        std::vector<std::uint8_t> bytes(std::size_t(extent_.width) * extent_.height * texel_);
        std::memcpy(bytes.data(), mapped_, bytes.size());
        return bytes;
    }
    /// RGB of R32G32B32A32_SFLOAT.
    std::vector<float> radiance() const {
        const std::vector<std::uint8_t> all = bytes();
        std::vector<float> rgb;
        for (std::size_t i = 0; i < all.size(); i += 16) {
            float texel[3];
            std::memcpy(texel, all.data() + i, sizeof(texel));
            rgb.insert(rgb.end(), texel, texel + 3);
        }
        return rgb;
    }

private:
    const vk::raii::Device& device_;
    vk::Extent2D extent_;
    vk::Format format_;
    vk::DeviceSize texel_;
    vk::raii::DeviceMemory image_memory_ = nullptr, buffer_memory_ = nullptr;
    vk::raii::Image image_;
    vk::raii::Buffer buffer_;
    void* mapped_ = nullptr;
};

/// RGBA8 of a picture.
std::vector<std::uint8_t> bytes_of(const Image& display) {
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i < display.pixels.size(); i += 3) {
        for (std::size_t c = 0; c < 3; ++c) bytes.push_back(std::uint8_t(std::lround(display.pixels[i + c] * 255.0f)));
        bytes.push_back(255);
    }
    return bytes;
}

RenderSettings settings_of(const char* technique, std::uint32_t side = 64, std::uint32_t samples = 1) {
    RenderSettings settings;
    settings.width = settings.height = side;
    settings.technique = technique;
    settings.samples = samples;
    return settings;
}

/// A ball and a goblet of glass on a floor.
Scene table_scene() {
    Scene scene = load_scene("shape:goblet");
    const Scene ball = load_scene("shape:sphere");
    scene.meshes.push_back(ball.meshes.front());
    scene.materials.push_back(ball.materials.front());
    Material floor;
    floor.base_color = glm::vec4(0.6f, 0.4f, 0.3f, 1.0f);
    floor.roughness = 1.0f;
    scene.materials.push_back(floor);
    const Scene cube = load_scene("shape:cube");
    scene.meshes.push_back(cube.meshes.front());
    glm::mat4 beside(0.3f);
    beside[3] = glm::vec4(0.9f, -0.5f, 0.2f, 1.0f);
    scene.objects.push_back({.name = "ball", .mesh = 1, .material = 1, .world_from_object = beside});
    glm::mat4 below(1.0f);
    below[0][0] = below[2][2] = 4.0f;
    below[1][1] = 0.05f;
    below[3] = glm::vec4(0.0f, -1.2f, 0.0f, 1.0f);
    scene.objects.push_back({.name = "floor", .mesh = 2, .material = 2, .world_from_object = below});
    Light lamp;
    lamp.position = {2.0f, 3.0f, 1.0f};
    lamp.intensity = glm::vec3(20.0f);
    scene.lights.push_back(lamp);
    return scene;
}

class FramesTest : public LentDeviceTest {
protected:
    void SetUp() override {
        LentDeviceTest::SetUp();
        if (IsSkipped()) return;
        lent_ = make_device(wanted_->features());
        renderer_.emplace(lent_);
        pool_ = vk::raii::CommandPool(device_, {.flags = vk::CommandPoolCreateFlagBits::eResetCommandBuffer,
                                                .queueFamilyIndex = lent_.queue_family});
    }
    void TearDown() override {
        renderer_.reset();
        LentDeviceTest::TearDown();
    }
    Renderer& renderer() { return *renderer_; }
    Screen screen(vk::Format format, std::uint32_t side = 64) { return {device_, physical_, format, {side, side}}; }
    vk::raii::CommandBuffer commands() {
        return std::move(device_.allocateCommandBuffers({.commandPool = *pool_, .commandBufferCount = 1}).front());
    }
    void run(const vk::raii::CommandBuffer& commands) {
        const vk::raii::Fence fence(device_, vk::FenceCreateInfo{});
        const vk::CommandBuffer handle = *commands;
        queue_.submit(vk::SubmitInfo{.commandBufferCount = 1, .pCommandBuffers = &handle}, *fence);
        ASSERT_EQ(device_.waitForFences(*fence, true, ~0ull), vk::Result::eSuccess);
    }
    /// A frame in commands of its own, and the copy of `screen` after it.
    FrameReport record(Frames& frames, const RenderSettings& settings, const Screen& screen) {
        const vk::raii::CommandBuffer own = commands();
        own.begin({});
        const Ticket ticket = frames.record(*own, settings, screen.target());
        screen.copy(own);
        own.end();
        run(own);
        return frames.read(ticket).value();
    }
    FrameReport submit(Frames& frames, const RenderSettings& settings, const Screen& screen) {
        const Ticket ticket = frames.submit(settings, screen.target());
        FrameReport report = frames.wait(ticket);
        const vk::raii::CommandBuffer own = commands();
        own.begin({});
        screen.copy(own);
        own.end();
        run(own);
        return report;
    }
    /// Frames until one has all samples of its picture.
    template <class Draw>
    FrameReport finish(const RenderSettings& settings, const Draw& draw) {
        for (int i = 0; i < 60; ++i) {
            FrameReport report = draw();
            if (report.samples == settings.samples) return report;
        }
        ADD_FAILURE() << settings.technique << ": the picture is never finished";
        return {};
    }

    vulkan::LentDevice lent_;
    std::optional<Renderer> renderer_;
    vk::raii::CommandPool pool_ = nullptr;
};

TEST_F(FramesTest, RecordedFramesAreThePicturesOfRender) {
    renderer().set_scene(table_scene());
    const Screen shown = screen(vk::Format::eR8G8B8A8Unorm);
    for (const TechniqueInfo* info : techniques()) {
        if (!info->recordable || !renderer().lacking(*info).empty()) continue;
        SCOPED_TRACE(info->name);
        RenderSettings settings = settings_of(std::string(info->name).c_str());
        settings.light.transport = LightTransport::kEnvironment;
        const RenderResult picture = renderer().render(settings);
        Frames frames(renderer());
        const FrameReport report = finish(settings, [&] { return record(frames, settings, shown); });
        EXPECT_EQ(shown.bytes(), bytes_of(picture.display));
        EXPECT_EQ(report.covered, picture.covered);
        EXPECT_EQ(report.status, picture.status);
        EXPECT_EQ(report.side_conflicts, picture.side_conflicts);
        EXPECT_THAT(report.warnings, ::testing::IsSubsetOf(picture.warnings));
        EXPECT_FALSE(report.passes.empty());
    }
}

TEST_F(FramesTest, SubmittedFramesAreThePicturesOfRender) {
    renderer().set_scene(table_scene());
    const Screen shown = screen(vk::Format::eR8G8B8A8Srgb);
    for (const char* technique : {"balanced", "fast", "visibility-cube"}) {
        for (const LightTransport light : {LightTransport::kDirect, LightTransport::kFull}) {
            SCOPED_TRACE(technique);
            RenderSettings settings = settings_of(technique);
            settings.light.transport = light;
            const RenderResult picture = renderer().render(settings);
            Frames frames(renderer());
            EXPECT_EQ(finish(settings, [&] { return submit(frames, settings, shown); }).light, light);
            EXPECT_EQ(shown.bytes(), bytes_of(picture.display));
        }
    }
}

TEST_F(FramesTest, TruthsAreTracedWhileTheCallerGoesOn) {
    renderer().set_scene(table_scene());
    const Screen shown = screen(vk::Format::eR32G32B32A32Sfloat);
    for (const char* technique : {"reference", "path"}) {
        SCOPED_TRACE(technique);
        const RenderSettings settings = settings_of(technique, 64, 4);
        const RenderResult picture = renderer().render(settings);
        Frames frames(renderer());
        finish(settings, [&] { return submit(frames, settings, shown); });
        const std::vector<float> seen = shown.radiance();
        ASSERT_EQ(seen.size(), picture.radiance.pixels.size());
        // The path tracer adds its samples up in double precision.
        for (std::size_t i = 0; i < seen.size(); ++i)
            ASSERT_NEAR(seen[i], picture.radiance.pixels[i], 1e-5f * (1.0f + picture.radiance.pixels[i]));
    }
    // What changes meanwhile ends the tracing of what was.
    RenderSettings large = settings_of("path", 512);
    large.parameters["photons"] = 1e6;
    const Screen screen_of_large = screen(vk::Format::eR8G8B8A8Unorm, 512);
    Frames frames(renderer());
    const Ticket ticket = frames.submit(large, screen_of_large.target());
    Light lamp = table_scene().lights.front();
    lamp.intensity *= 2.0f;
    renderer().set_light(0, lamp);
    EXPECT_EQ(frames.wait(ticket).samples, 0u);
    // And the next frames have what is now.
    const RenderSettings settings = settings_of("reference", 64);
    const Screen small = screen(vk::Format::eR8G8B8A8Unorm);
    finish(settings, [&] { return submit(frames, settings, small); });
}

TEST_F(FramesTest, SamplesAddUpToAStill) {
    renderer().set_scene(table_scene());
    const Screen shown = screen(vk::Format::eR32G32B32A32Sfloat);
    for (const char* technique : {"balanced", "wang-2014"}) {
        SCOPED_TRACE(technique);
        const RenderSettings settings = settings_of(technique, 64, 8);  // enough for all light
        const RenderResult picture = renderer().render(settings);
        EXPECT_EQ(picture.light, LightTransport::kFull);
        Frames frames(renderer());
        EXPECT_EQ(finish(settings, [&] { return submit(frames, settings, shown); }).light, LightTransport::kFull);
        EXPECT_EQ(shown.radiance(), picture.radiance.pixels);
        // A finished picture is shown again, and costs nothing.
        const FrameReport again = submit(frames, settings, shown);
        EXPECT_EQ(again.samples, 8u);
        EXPECT_LE(again.passes.size(), 1u);
        EXPECT_EQ(shown.radiance(), picture.radiance.pixels);
    }
}

/// Of the caller's, filled by the host: what the program has drawn.
struct DepthImage {
    DepthImage(const vk::raii::Device& device, const vk::raii::PhysicalDevice& physical,
               const vk::raii::CommandBuffer& commands, const std::vector<float>& depths, std::uint32_t side)
        : image(device, vk::ImageCreateInfo{.imageType = vk::ImageType::e2D,
                                            .format = vk::Format::eD32Sfloat,
                                            .extent = {side, side, 1},
                                            .mipLevels = 1,
                                            .arrayLayers = 1,
                                            .usage = vk::ImageUsageFlagBits::eTransferDst |
                                                     vk::ImageUsageFlagBits::eTransferSrc}),
          buffer(device, vk::BufferCreateInfo{.size = depths.size() * sizeof(float),
                                              .usage = vk::BufferUsageFlagBits::eTransferSrc}) {
        using Property = vk::MemoryPropertyFlagBits;
        image_memory = allocate(device, physical, image.getMemoryRequirements(), {});
        buffer_memory = allocate(device, physical, buffer.getMemoryRequirements(),
                                 Property::eHostVisible | Property::eHostCoherent);
        image.bindMemory(*image_memory, 0);
        buffer.bindMemory(*buffer_memory, 0);
        std::memcpy(buffer_memory.mapMemory(0, VK_WHOLE_SIZE), depths.data(), depths.size() * sizeof(float));
        change(commands, vk::ImageLayout::eUndefined, vk::ImageLayout::eTransferDstOptimal);
        commands.copyBufferToImage(
            *buffer, *image, vk::ImageLayout::eTransferDstOptimal,
            vk::BufferImageCopy{.imageSubresource = {.aspectMask = vk::ImageAspectFlagBits::eDepth, .layerCount = 1},
                                .imageExtent = {side, side, 1}});
        change(commands, vk::ImageLayout::eTransferDstOptimal, vk::ImageLayout::eTransferSrcOptimal);
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
            .subresourceRange = {.aspectMask = vk::ImageAspectFlagBits::eDepth, .levelCount = 1, .layerCount = 1}};
        commands.pipelineBarrier2({.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier});
    }
    vk::raii::DeviceMemory image_memory = nullptr, buffer_memory = nullptr;
    vk::raii::Image image;
    vk::raii::Buffer buffer;
};

// A floor and a pillar that a program draws, against the same as objects of the scene.
TEST_F(FramesTest, WhatTheCallerHasDrawnIsSeenThroughGlass) {
    Scene whole = table_scene();
    whole.lights.clear();
    whole.objects.erase(whole.objects.begin() + 1);  // the ball
    whole.materials[2].unlit = true;                 // the floor; the caller lights as it likes
    Object pillar = whole.objects.back();
    pillar.world_from_object = glm::mat4(0.15f);
    pillar.world_from_object[1][1] = 0.5f;
    pillar.world_from_object[3] = glm::vec4(0.6f, -0.7f, 1.2f, 1.0f);  // before the glass
    whole.objects.push_back(pillar);
    Scene glass = whole, drawn = whole;
    glass.objects.resize(1);
    drawn.objects.erase(drawn.objects.begin());
    const std::uint32_t side = 96;
    Camera camera = orbit_camera(scene_bounds(glass), 10.0f, 20.0f, 4.5f, 0.6f);
    camera.near_plane = 0.5f;
    camera.far_plane = 40.0f;
    renderer().set_camera(camera);
    RenderSettings settings = settings_of("one-interface", side);
    settings.light.transport = LightTransport::kEnvironment;

    // The caller's colour and depth. As if it were of glass, what is opaque has a depth AOV.
    const Screen color = screen(vk::Format::eR32G32B32A32Sfloat, side);
    renderer().set_scene(drawn);
    {
        Frames frames(renderer());
        finish(settings, [&] { return record(frames, settings, color); });
    }
    Scene of_glass = drawn;
    of_glass.materials[2] = whole.materials[0];
    renderer().set_scene(of_glass);
    RenderSettings with_depth = settings;
    with_depth.aovs = {"depth"};
    const Image depth = renderer().render(with_depth).aovs.at("depth");
    const float n = camera.near_plane, f = camera.far_plane;
    std::vector<float> depths;
    for (const float z : depth.pixels) depths.push_back(z > 0.0f ? f / (f - n) * (1.0f - n / z) : 1.0f);
    const vk::raii::CommandBuffer upload = commands();
    upload.begin({});
    const DepthImage depth_image(device_, physical_, upload, depths, side);
    upload.end();
    run(upload);
    const vulkan::Background background{
        .color = color.target().image, .depth = *depth_image.image, .zz = f / (n - f), .zw = f * n / (n - f)};

    const Screen shown = screen(vk::Format::eR32G32B32A32Sfloat, side);
    for (const char* technique : {"visibility-layers", "visibility-cube"}) {
        SCOPED_TRACE(technique);
        settings.technique = technique;
        renderer().set_scene(whole);
        RenderSettings of_truth = settings;
        of_truth.aovs = {"depth"};
        const RenderResult truth = renderer().render(of_truth);
        renderer().set_scene(glass);
        const RenderResult alone = renderer().render(settings);
        Frames frames(renderer());
        finish(settings, [&] {
            const vk::raii::CommandBuffer own = commands();
            own.begin({});
            const Ticket ticket = frames.record(*own, settings, shown.target(), &background);
            shown.copy(own);
            own.end();
            run(own);
            return frames.read(ticket).value();
        });
        const std::vector<float> seen = shown.radiance();
        std::size_t close = 0, close_alone = 0, changed = 0;
        for (std::size_t i = 0; i < seen.size(); i += 3) {
            const glm::vec3 here(seen[i], seen[i + 1], seen[i + 2]);
            const auto of = [&](const RenderResult& result) {
                return glm::vec3(result.radiance.pixels[i], result.radiance.pixels[i + 1],
                                 result.radiance.pixels[i + 2]);
            };
            // Where there is no glass, everything is as the caller has drawn it.
            if (truth.aovs.at("depth").pixels[i / 3] == 0.0f) {
                EXPECT_LT(glm::distance(here, of(truth)), 1e-5f);
                continue;
            }
            ++changed;
            close += glm::distance(here, of(truth)) < 0.05f ? 1 : 0;
            close_alone += glm::distance(of(alone), of(truth)) < 0.05f ? 1 : 0;
        }
        // Glass also shows what the picture does not: undersides and what lies beside it.
        EXPECT_GT(double(close), 0.85 * double(changed)) << close << " of " << changed;
        EXPECT_LT(double(changed - close), 0.35 * double(changed - close_alone)) << close_alone << " without";
    }
}

TEST_F(FramesTest, ChannelsAreInTheTargetsOrder) {
    renderer().set_scene(table_scene());
    const Screen rgba = screen(vk::Format::eR8G8B8A8Unorm), bgra = screen(vk::Format::eB8G8R8A8Unorm);
    const RenderSettings settings = settings_of("one-interface");
    Frames frames(renderer());
    finish(settings, [&] { return record(frames, settings, rgba); });
    finish(settings, [&] { return record(frames, settings, bgra); });
    std::vector<std::uint8_t> swapped = bgra.bytes();
    for (std::size_t i = 0; i < swapped.size(); i += 4) std::swap(swapped[i], swapped[i + 2]);
    EXPECT_EQ(swapped, rgba.bytes());
}

// Recorded before either has run, of different sizes, so that one takes the other's images away.
TEST_F(FramesTest, TwoAreInFlight) {
    renderer().set_scene(table_scene());
    const Screen small = screen(vk::Format::eR8G8B8A8Unorm, 48), large = screen(vk::Format::eR8G8B8A8Unorm, 80);
    const RenderSettings of_small = settings_of("visibility-layers", 48),
                         of_large = settings_of("visibility-layers", 80);
    const Bounds bounds = scene_bounds(table_scene());
    const Camera left = orbit_camera(bounds, -40.0f, 10.0f, 4.0f, 0.6f),
                 right = orbit_camera(bounds, 60.0f, 30.0f, 5.0f, 0.6f);
    Frames frames(renderer());
    for (int round = 0; round < 3; ++round) {  // the first two learn how much room frames need
        const vk::raii::CommandBuffer first = commands(), second = commands();
        first.begin({});
        renderer().set_camera(left);
        const Ticket one = frames.record(*first, of_small, small.target());
        small.copy(first);
        first.end();
        second.begin({});
        renderer().set_camera(right);
        const Ticket two = frames.record(*second, of_large, large.target());
        large.copy(second);
        second.end();
        EXPECT_THAT([&] { frames.record(*second, of_large, large.target()); },
                    ThrowsMessage<Error>(HasSubstr("in flight")));
        EXPECT_FALSE(frames.read(one).has_value());
        EXPECT_THAT([&] { renderer().render(of_small); }, ThrowsMessage<Error>(HasSubstr("not been read")));
        run(first);
        EXPECT_THAT([&] { frames.read(two); }, ThrowsMessage<Error>(HasSubstr("oldest")));
        EXPECT_TRUE(frames.read(one).has_value());
        run(second);
        EXPECT_TRUE(frames.read(two).has_value());
    }
    renderer().set_camera(left);
    EXPECT_EQ(small.bytes(), bytes_of(renderer().render(of_small).display));
    renderer().set_camera(right);
    EXPECT_EQ(large.bytes(), bytes_of(renderer().render(of_large).display));
}

TEST_F(FramesTest, SteadyFramesMakeNothing) {
    renderer().set_scene(table_scene());
    const Screen shown = screen(vk::Format::eR8G8B8A8Unorm);
    const Bounds bounds = scene_bounds(table_scene());
    for (const char* technique : {"visibility-layers", "fast", "balanced"}) {
        SCOPED_TRACE(technique);
        RenderSettings settings = settings_of(technique);
        settings.light.transport = LightTransport::kDirect;
        Frames frames(renderer());
        const auto draw = [&](int frame) {
            renderer().set_camera(orbit_camera(bounds, 0.1f * float(frame), 15.0f, 4.0f, 0.6f));
            return submit(frames, settings, shown);
        };
        for (int i = 0; i < 10; ++i) draw(i);
        const vulkan::Made before = frames.made();
        for (int i = 10; i < 30; ++i) EXPECT_TRUE(draw(i).overflows.empty());
        const vulkan::Made after = frames.made();
        EXPECT_EQ(after.allocations, before.allocations);
        EXPECT_EQ(after.pipelines, before.pipelines);
        EXPECT_EQ(after.pools, before.pools);
    }
}

TEST_F(FramesTest, SizesThatAlternateMakeNothing) {
    renderer().set_scene(table_scene());
    const Screen shown = screen(vk::Format::eR8G8B8A8Unorm);
    const Bounds bounds = scene_bounds(table_scene());
    for (const char* technique : {"visibility-layers", "fast", "balanced"}) {
        SCOPED_TRACE(technique);
        Frames frames(renderer());
        const auto draw = [&](int frame) {
            renderer().set_camera(orbit_camera(bounds, 0.1f * float(frame), 15.0f, 4.0f, 0.6f));
            return submit(frames, settings_of(technique, frame / 2 % 2 == 0 ? 64 : 48), shown);
        };
        for (int i = 0; i < 12; ++i) draw(i);
        const vulkan::Made before = frames.made();
        for (int i = 12; i < 32; ++i) EXPECT_TRUE(draw(i).overflows.empty());
        EXPECT_EQ(frames.made().allocations, before.allocations);
    }
}

TEST_F(FramesTest, WhatIsSetIsSeenByTheNextFrame) {
    Scene scene = table_scene();
    renderer().set_scene(scene);
    Environment environment = uniform_environment(glm::vec3(0.4f));
    environment.kind = Environment::Kind::kStudio;
    renderer().set_environment(environment);
    const Camera camera = orbit_camera(scene_bounds(scene), 20.0f, 20.0f, 4.0f, 0.6f);
    renderer().set_camera(camera);
    const Screen shown = screen(vk::Format::eR8G8B8A8Unorm);
    for (const char* technique : {"balanced", "wyman-2005"}) {
        SCOPED_TRACE(technique);
        RenderSettings settings = settings_of(technique);
        settings.light.transport = LightTransport::kDirect;
        Frames frames(renderer());
        const auto draw = [&] { return submit(frames, settings, shown); };
        const auto expect_fresh = [&](const char* what) {
            SCOPED_TRACE(what);
            finish(settings, draw);
            Renderer fresh(lent_);
            fresh.set_scene(scene);
            fresh.set_environment(environment);
            fresh.set_camera(camera);
            EXPECT_EQ(shown.bytes(), bytes_of(fresh.render(settings).display));
        };
        finish(settings, draw);
        scene.objects[1].world_from_object[3].x -= 0.3f;
        renderer().set_transforms({{1, scene.objects[1].world_from_object}});
        expect_fresh("transform");
        scene.materials[1].ior = 1.9f;
        scene.materials[1].attenuation_color = {0.2f, 0.9f, 0.4f};
        scene.materials[1].attenuation_distance = 0.4f;
        renderer().set_material(1, scene.materials[1]);
        expect_fresh("medium");
        scene.materials[2].base_color = {0.1f, 0.2f, 0.9f, 1.0f};
        renderer().set_material(2, scene.materials[2]);
        expect_fresh("colour");
        std::swap(scene.materials[1].thickness, scene.materials[1].transmission);
        scene.materials[1].transmission = scene.materials[1].thickness > 0.0f ? 0.0f : 1.0f;
        renderer().set_material(1, scene.materials[1]);
        expect_fresh("another kind of material");
        scene.materials[1] = load_scene("shape:sphere").materials.front();
        renderer().set_material(1, scene.materials[1]);
        expect_fresh("glass again");
        scene.lights[0].position.x -= 1.0f;
        renderer().set_light(0, scene.lights[0]);
        expect_fresh("light");
        environment.rotation += 1.0f;
        environment.intensity = 0.7f;
        renderer().turn_environment(environment.rotation, environment.intensity);
        expect_fresh("environment");
        for (glm::vec3& p : scene.meshes[0].positions) p *= 0.9f;
        renderer().set_positions({{0, scene.meshes[0].positions, scene.meshes[0].normals}});
        expect_fresh("vertices");
    }
}

TEST_F(FramesTest, WhatHasNoRoomIsSaid) {
    renderer().set_scene(load_scene("shape:infinity-ring"));
    const Screen shown = screen(vk::Format::eR8G8B8A8Unorm);
    const RenderSettings settings = settings_of("visibility-layers");
    Frames frames(renderer());
    const FrameReport first = record(frames, settings, shown);
    EXPECT_FALSE(first.overflows.empty());
    EXPECT_EQ(first.samples, 0u);
    const FrameReport last = finish(settings, [&] { return record(frames, settings, shown); });
    EXPECT_TRUE(last.overflows.empty());
}

TEST_F(FramesTest, WhatCannotBeIsRefused) {
    renderer().set_scene(load_scene("shape:sphere"));
    const Screen shown = screen(vk::Format::eR8G8B8A8Unorm);
    const vk::raii::CommandBuffer own = commands();
    own.begin({});
    Frames frames(renderer());
    const auto record = [&](const RenderSettings& settings, const Target& target) {
        return [&, settings, target] { frames.record(*own, settings, target); };
    };
    EXPECT_THAT(record(settings_of("reference"), shown.target()),
                ThrowsMessage<Error>(HasSubstr("reference has parts")));
    RenderSettings aov = settings_of("one-interface");
    aov.aovs = {"depth"};
    EXPECT_THAT(record(aov, shown.target()), ThrowsMessage<Error>(HasSubstr("AOVs")));
    Target target = shown.target();
    target.format = VK_FORMAT_R16_UNORM;
    EXPECT_THAT(record(settings_of("one-interface"), target), ThrowsMessage<Error>(HasSubstr("R16")));
    target = shown.target();
    target.layout_after = VK_IMAGE_LAYOUT_UNDEFINED;
    EXPECT_THAT(record(settings_of("one-interface"), target), ThrowsMessage<Error>(HasSubstr("layout")));
    EXPECT_THAT([&] { Frames(renderer(), 9); }, ThrowsMessage<Error>(HasSubstr("1 to 8")));
    EXPECT_THAT([&] { frames.read(1); }, ThrowsMessage<Error>(HasSubstr("oldest")));
    EXPECT_THAT(
        [&] {
            renderer().set_transforms({{7, glm::mat4(1.0f)}});
        },
        ThrowsMessage<Error>(HasSubstr("object 7")));
    EXPECT_THAT(
        [&] {
            renderer().set_transforms({{0, glm::mat4(0.0f)}});
        },
        ThrowsMessage<Error>(HasSubstr("invertible")));
    EXPECT_THAT([&] { renderer().set_material(3, {}); }, ThrowsMessage<Error>(HasSubstr("material 3")));
    EXPECT_THAT([&] { renderer().set_light(0, {}); }, ThrowsMessage<Error>(HasSubstr("light 0")));
    own.end();
}

}  // namespace
}  // namespace pellucid::test
