// The recorder's promises: barriers, and mismatches that name both sides.
#include "gpu/device_test.h"
#include "gpu_tests/shaders.h"

#include <gmock/gmock.h>

#include <stdexcept>

namespace pellucid::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

using RecorderTest = DeviceTest;

TEST_F(RecorderTest, MismatchesNameShaderAndPass) {
    const Program& program = workspace().compute(shaders::optics_twin_comp);
    const Buffer& buffer = workspace().buffer("b", 64);
    const GpuImage& image = workspace().image("i", vk::Format::eR32Uint, {1, 1});
    const auto record = [&](Binding second) { recorder().compute(program, {reads("Cases", buffer), second}, {1, 1}); };
    EXPECT_THAT([&] { record(writes("answers", buffer)); },
                ThrowsMessage<std::logic_error>(AllOf(HasSubstr("optics_twin.comp"), HasSubstr("Answers"))));
    EXPECT_THAT([&] { record(reads("Answers", buffer)); },
                ThrowsMessage<std::logic_error>(AllOf(HasSubstr("shader writes 'Answers'"), HasSubstr("pass reads"))));
    EXPECT_THAT([&] { record(writes("Answers", image)); },
                ThrowsMessage<std::logic_error>(HasSubstr("the other kind")));
    EXPECT_THAT(
        [&] {
            recorder().compute(program, {reads("Cases", buffer)}, {1, 1});
        },
        ThrowsMessage<std::logic_error>(HasSubstr("2 bindings")));
    EXPECT_THAT(
        [&] {
            recorder().compute(program, {reads("Cases", buffer), writes("Answers", buffer)}, 1.0f, {1, 1});
        },
        ThrowsMessage<std::logic_error>(HasSubstr("push constants")));
    recorder().restart();
}

TEST_F(RecorderTest, OrdersDependentCommands) {
    const Buffer& a = workspace().buffer("a", 1 << 16);
    const Buffer& b = workspace().buffer("b", 1 << 16);
    const Buffer& host = workspace().buffer("host", 1 << 16, true);
    for (std::uint32_t round = 1; round <= 20; ++round) {
        recorder().fill(a, round);
        recorder().copy(a, b, a.size());
        recorder().fill(a, 1000);  // after the copy has read it
        recorder().copy(b, host, b.size());
        recorder().submit_and_wait();
        EXPECT_EQ(read_back<std::uint32_t>(host), std::vector<std::uint32_t>((1 << 16) / 4, round));
    }
}

TEST_F(RecorderTest, ScopesOfOneNameAddUp) {
    const Buffer& a = workspace().buffer("a", 1 << 20);
    for (int i = 0; i < 100; ++i) {  // more than one query pool
        const Recorder::Scope scope(recorder(), i % 2 ? "odd" : "even");
        recorder().fill(a, 1);
    }
    const std::vector<PassTime> times = recorder().submit_and_wait();
    if (device().timestamp_period_ns() == 0.0) GTEST_SKIP() << "the queue has no timestamps";
    ASSERT_EQ(times.size(), 2u);
    EXPECT_EQ(times[0].name, "even");
    EXPECT_EQ(times[1].name, "odd");
    EXPECT_GT(times[0].time_ms, 0.0);
}

// Without this one, silence of the validation layer would prove nothing.
TEST(ValidationLayer, SeesAMissingBarrier) {
    std::optional<Device> device;
    try {
        device.emplace(DeviceOptions{.device = {}, .validation = true});
    } catch (const DeviceError& error) {
        GTEST_SKIP() << error.what();
    }
    using Usage = vk::BufferUsageFlagBits;
    const Buffer a(*device, "a", 1024, Usage::eTransferSrc | Usage::eTransferDst);
    const Buffer b(*device, "b", 1024, Usage::eTransferDst);
    const vk::raii::CommandPool pool = device->handle().createCommandPool({.queueFamilyIndex = device->queue_family()});
    const auto commands = device->handle().allocateCommandBuffers({.commandPool = *pool, .commandBufferCount = 1});
    commands[0].begin({});
    commands[0].fillBuffer(a.handle(), 0, VK_WHOLE_SIZE, 1);
    commands[0].copyBuffer(a.handle(), b.handle(), vk::BufferCopy{.size = 1024});  // reads what may not be there yet
    commands[0].end();
    ASSERT_FALSE(device->validation_messages().empty());
    EXPECT_THAT(device->validation_messages().front(), HasSubstr("HAZARD"));
}

}  // namespace
}  // namespace pellucid::test
