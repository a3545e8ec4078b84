#pragma once

// Tests on a Vulkan device whose calls fail when a test wants it; see failing_layer.cpp.
#include "gpu/gpu_test.h"
#include "trust/failing_layer.h"

#include <dlfcn.h>

namespace pellucid::test {

class FailingDeviceTest : public ::testing::Test {
protected:
    void SetUp() override {
        const std::string folder = PELLUCID_FAILING_LAYER_FOLDER;
        library_ = dlopen((folder + "/libpellucid_failing_layer.so").c_str(), RTLD_NOW);
        ASSERT_NE(library_, nullptr) << dlerror();
        failures_ = reinterpret_cast<Failures* (*)()>(dlsym(library_, "pellucid_failures"))();
        setenv("VK_ADD_LAYER_PATH", folder.c_str(), 1);
        setenv("VK_INSTANCE_LAYERS", "VK_LAYER_PELLUCID_failing", 1);
        stop_failing();
        try {
            Renderer{validated()};
        } catch (const DeviceError& error) {
            GTEST_SKIP() << error.what();
        }
        ASSERT_GT(failures().allocations, 0u) << "the Vulkan loader has not found the layer";
    }
    void TearDown() override {
        stop_failing();
        unsetenv("VK_INSTANCE_LAYERS");
        unsetenv("VK_ADD_LAYER_PATH");
        dlclose(library_);
    }

    static DeviceOptions validated() { return {.device = {}, .validation = true}; }
    Failures& failures() { return *failures_; }
    /// Counts from 0 again, and lets every call succeed.
    void stop_failing() {
        failures().allocations = failures().objects = failures().submissions = 0;
        failures().first_allocation = failures().first_object = failures().first_submission = Failures::kNever;
        failures().lose_in_wait = false;
    }

private:
    void* library_ = nullptr;
    Failures* failures_ = nullptr;
};

}  // namespace pellucid::test
