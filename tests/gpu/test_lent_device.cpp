// The renderer on a device that its caller has made, and keeps.
#include "gpu/lent_device_test.h"

#include <gmock/gmock.h>

namespace pellucid::test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class LentDevice : public LentDeviceTest {};

RenderResult draw(Renderer& renderer) {
    renderer.set_scene(load_scene("shape:goblet"));
    RenderSettings settings;
    settings.width = settings.height = 64;
    settings.technique = "visibility-layers";
    settings.samples = 2;
    return renderer.render(settings);
}

TEST_F(LentDevice, HasThePictureOfADeviceOfOnesOwn) {
    const vulkan::LentDevice lent = make_device(wanted_->features());
    RenderResult drawn;
    std::string name;
    {
        Renderer renderer(lent);
        drawn = draw(renderer);
        name = renderer.device().name;
    }
    device_.waitIdle();  // still the caller's
    const vk::raii::Fence fence(device_, vk::FenceCreateInfo{});
    Renderer own(DeviceOptions{.device = name});
    EXPECT_EQ(drawn.radiance.pixels, draw(own).radiance.pixels);
    EXPECT_EQ(own.device().absent, Renderer(lent).device().absent);
}

TEST_F(LentDevice, MustHaveBeenMadeWithWhatIsNeeded) {
    vk::PhysicalDeviceVulkan13Features features13{.synchronization2 = true, .maintenance4 = true};
    const vk::PhysicalDeviceFeatures2 features{.pNext = &features13};
    const vulkan::LentDevice lent = make_device(&static_cast<const VkPhysicalDeviceFeatures2&>(features));
    EXPECT_THAT([&] { Renderer renderer(lent); }, ThrowsMessage<DeviceError>(HasSubstr("without dynamicRendering")));
    device_.waitIdle();
}

// Structures of single features say the same as those of a version.
TEST_F(LentDevice, MayLackWhatIsOptional) {
    vk::PhysicalDeviceMaintenance4Features maintenance{.maintenance4 = true};
    vk::PhysicalDeviceSynchronization2Features synchronization{.pNext = &maintenance, .synchronization2 = true};
    vk::PhysicalDeviceDynamicRenderingFeatures rendering{.pNext = &synchronization, .dynamicRendering = true};
    const vk::PhysicalDeviceFeatures2 features{.pNext = &rendering};
    Renderer renderer(make_device(&static_cast<const VkPhysicalDeviceFeatures2&>(features)));
    EXPECT_THAT(renderer.device().absent, ::testing::Contains(HasSubstr("fragmentStoresAndAtomics")));
    EXPECT_TRUE(all_finite(draw(renderer).radiance));
}

TEST_F(LentDevice, MustBeWhole) {
    vulkan::LentDevice lent = make_device(wanted_->features());
    lent.features = nullptr;
    EXPECT_THAT([&] { Renderer renderer(lent); }, ThrowsMessage<DeviceError>(HasSubstr("features")));
    EXPECT_THAT([] { Renderer renderer(vulkan::LentDevice{}); }, ThrowsMessage<DeviceError>(HasSubstr("instance")));
}

}  // namespace
}  // namespace pellucid::test
