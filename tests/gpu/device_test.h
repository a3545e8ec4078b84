#pragma once

// Tests of the rooms below the renderer: a validated device with what records on it.
#include "gpu/recorder.h"
#include "gpu/workspace.h"

#include "gpu/gpu_test.h"

#include <cstring>

namespace pellucid::test {

class DeviceTest : public ::testing::Test {
protected:
    void SetUp() override {
        try {
            device_.emplace(DeviceOptions{.device = {}, .validation = true});
        } catch (const DeviceError& error) {
            GTEST_SKIP() << error.what();
        }
        workspace_.emplace(*device_);
        recorder_.emplace(*device_);
    }
    void TearDown() override {
        if (device_) expect_silent(device_->validation_messages());
    }
    const Device& device() { return *device_; }
    Workspace& workspace() { return *workspace_; }
    Recorder& recorder() { return *recorder_; }

private:
    std::optional<Device> device_;
    std::optional<Workspace> workspace_;
    std::optional<Recorder> recorder_;
};

template <class T>
std::vector<T> read_back(const Buffer& host_buffer) {
    std::vector<T> values(host_buffer.size() / sizeof(T));
    std::memcpy(values.data(), host_buffer.mapped(), host_buffer.size());
    return values;
}

template <class T>
std::vector<T> read_back(const Device& device, const GpuImage& image, std::uint32_t layer) {
    const std::vector<std::byte> bytes = download(device, image, layer);
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

}  // namespace pellucid::test
