#pragma once

// Tests on a device that a program has made for itself, and lends.
#include "gpu/gpu_test.h"
#include "gpu/vulkan.h"

#include <pellucid/vulkan.h>

namespace pellucid::test {

/// A program's own Vulkan, with core and synchronisation validation.
class LentDeviceTest : public ::testing::Test {
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

}  // namespace pellucid::test
