// The renderer on a device that its caller has made, and keeps.
#include "gpu/gpu_test.h"
#include "gpu/vulkan.h"

#include <pellucid/vulkan.h>

#include <gmock/gmock.h>

namespace pellucid::test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// A program's own Vulkan, with core and synchronisation validation.
class LentDevice : public ::testing::Test {
protected:
    void SetUp() override {
        try {
            make_instance();
            vk::raii::PhysicalDevices physicals(instance_);
            physical_ = std::move(physicals.front());
            wanted_.emplace(*instance_, *physical_);
        } catch (const vk::SystemError& error) {
            GTEST_SKIP() << error.what();
        } catch (const DeviceError& error) {
            GTEST_SKIP() << error.what();
        }
    }
    void TearDown() override { expect_silent(messages_); }

    void make_instance() {
        const std::array layers = {"VK_LAYER_KHRONOS_validation"};
        const std::array extensions = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
        const std::array checks = {vk::ValidationFeatureEnableEXT::eSynchronizationValidation};
        const vk::ValidationFeaturesEXT validation{.enabledValidationFeatureCount = checks.size(),
                                                   .pEnabledValidationFeatures = checks.data()};
        const vk::ApplicationInfo application{.apiVersion = VK_API_VERSION_1_3};
        instance_ = vk::raii::Instance(context_, {.pNext = &validation,
                                                  .pApplicationInfo = &application,
                                                  .enabledLayerCount = layers.size(),
                                                  .ppEnabledLayerNames = layers.data(),
                                                  .enabledExtensionCount = extensions.size(),
                                                  .ppEnabledExtensionNames = extensions.data()});
        using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
        messenger_ =
            instance_.createDebugUtilsMessengerEXT({.messageSeverity = Severity::eWarning | Severity::eError,
                                                    .messageType = vk::DebugUtilsMessageTypeFlagBitsEXT::eValidation,
                                                    .pfnUserCallback = &note,
                                                    .pUserData = &messages_});
    }
    static VkBool32 VKAPI_CALL note(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                    const VkDebugUtilsMessengerCallbackDataEXT* data, void* messages) {
        static_cast<std::vector<std::string>*>(messages)->emplace_back(data->pMessage);
        return VK_FALSE;
    }
    /// With `features`, and the extensions that Pellucid wants.
    vulkan::LentDevice make_device(const VkPhysicalDeviceFeatures2* features) {
        const float priority = 1.0f;
        const vk::DeviceQueueCreateInfo queue{
            .queueFamilyIndex = wanted_->queue_family(), .queueCount = 1, .pQueuePriorities = &priority};
        const auto extensions = wanted_->extensions();
        device_ = physical_.createDevice({.pNext = features,
                                          .queueCreateInfoCount = 1,
                                          .pQueueCreateInfos = &queue,
                                          .enabledExtensionCount = std::uint32_t(extensions.size()),
                                          .ppEnabledExtensionNames = extensions.data()});
        queue_ = device_.getQueue(wanted_->queue_family(), 0);
        return {*instance_, *physical_, *device_, *queue_, wanted_->queue_family(), features, extensions};
    }

    std::vector<std::string> messages_;
    vk::raii::Context context_;
    vk::raii::Instance instance_ = nullptr;
    vk::raii::DebugUtilsMessengerEXT messenger_ = nullptr;
    vk::raii::PhysicalDevice physical_ = nullptr;
    std::optional<vulkan::DeviceFeatures> wanted_;
    vk::raii::Device device_ = nullptr;
    vk::raii::Queue queue_ = nullptr;
};

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
