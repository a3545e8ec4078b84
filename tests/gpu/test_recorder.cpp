// The recorder's promises: barriers, and mismatches that name both sides.
#include "gpu/counted_buffer.h"
#include "gpu/device_test.h"
#include "gpu_tests/shaders.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <vector>

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
        ThrowsMessage<std::logic_error>(HasSubstr("declares 'Answers'")));
    EXPECT_THAT(
        [&] {
            recorder().compute(program, {reads("Cases", buffer), writes("Answers", buffer)}, 1.0f, {1, 1});
        },
        ThrowsMessage<std::logic_error>(HasSubstr("push constants")));
    recorder().restart();
}

TEST_F(RecorderTest, WorkspacesKeepFewSizes) {
    workspace().keep(64);
    std::vector<std::weak_ptr<const void>> made;
    for (std::uint32_t side = 1; side <= 40; ++side) {
        workspace().trim();
        made.push_back(workspace().image("i", vk::Format::eR32Uint, {side, side}).held());
        const auto kept = std::ranges::count_if(made, [](const auto& image) { return !image.expired(); });
        EXPECT_LE(std::size_t(kept), Workspace::kMostSizes);
    }
    workspace().image("i", vk::Format::eR32Uint, {37, 37});
    EXPECT_FALSE(made[36].expired());
    workspace().clear();
    EXPECT_TRUE(std::ranges::all_of(made, [](const auto& image) { return image.expired(); }));
    workspace().keep(0);
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

TEST_F(RecorderTest, ReadsValues) {
    using Values = std::array<std::uint32_t, 1024>;
    const Buffer& a = workspace().buffer("a", 2 * sizeof(Values));
    std::vector<std::uint32_t> read;
    for (std::uint32_t i = 0; i < 40; ++i) {  // more than one buffer on the host holds
        recorder().fill(a, sizeof(Values), sizeof(Values), i);
        recorder().read<Values>(a, sizeof(Values), [&](const Values& values) {
            EXPECT_EQ(values.front(), values.back());
            read.push_back(values.front());
        });
    }
    EXPECT_TRUE(read.empty());
    recorder().submit_and_wait();
    std::vector<std::uint32_t> expected(40);
    std::iota(expected.begin(), expected.end(), 0u);
    EXPECT_EQ(read, expected);
}

TEST_F(RecorderTest, CountedBuffersGrowToWhatWasCounted) {
    CountedBuffer counted("items", 12);
    const auto needs_more = [&](std::initializer_list<std::uint32_t> counts) {
        for (const std::uint32_t count : counts) {
            recorder().fill(counted.begin(recorder(), workspace(), 10), 0, 4, count);  // as shaders would count
            counted.end(recorder());
        }
        recorder().submit_and_wait();
        return counted.grow();
    };
    EXPECT_FALSE(needs_more({10, 3}));
    EXPECT_EQ(counted.capacity(), 10u);
    EXPECT_TRUE(needs_more({4, 100, 5}));
    EXPECT_EQ(counted.capacity(), 125u);
    EXPECT_FALSE(needs_more({125}));
    const std::uint32_t most = counted.limit(device());
    EXPECT_TRUE(needs_more({most}));
    EXPECT_EQ(counted.capacity(), most);
    counted.set_capacity(10);
    EXPECT_TRUE(needs_more({most + 1}));
    EXPECT_THAT([&] { counted.begin(recorder(), workspace(), 10); }, ThrowsMessage<TooLarge>(HasSubstr("items")));
    recorder().restart();
}

TEST_F(RecorderTest, ProgramsNameTheLimitThatTheyExceed) {
    vk::PhysicalDeviceLimits limits = device().limits();
    EXPECT_EQ(lacking_limit(shaders::eikonal_twin_comp, limits), "");
    limits.maxPerStageDescriptorSampledImages = 1;
    EXPECT_EQ(lacking_limit(shaders::eikonal_twin_comp, limits), "2 sampled images per shader stage (it has 1)");
    limits.maxPerStageDescriptorStorageBuffers = 2;
    EXPECT_EQ(lacking_limit(shaders::eikonal_twin_comp, limits), "3 storage buffers per shader stage (it has 2)");
}

TEST_F(RecorderTest, ConstantsOfAShaderHaveToBeNamed) {
    EXPECT_THAT(
        [&] {
            workspace().compute(shaders::eikonal_twin_comp, {{"kCubical", true}});
        },
        ThrowsMessage<std::logic_error>(HasSubstr("no value for the constant 'kCubic'")));
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
