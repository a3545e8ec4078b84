// What a program meets when its device runs out of memory or is lost: one clear error, and the next call works.
#include "gpu/vulkan.h"
#include "trust/failing_device_test.h"
#include "trust/trust_scenes.h"

#include <pellucid/vulkan.h>

#include <gmock/gmock.h>

namespace pellucid::test {
namespace {

using ::testing::HasSubstr;

RenderSettings settings_of(std::string_view technique, std::uint32_t width = 24) {
    RenderSettings settings;
    settings.width = width;
    settings.height = 20;
    settings.technique = technique;
    return settings;
}

void expect_one_line(const std::exception& error, const std::string& about) {
    EXPECT_THAT(error.what(), HasSubstr(about));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
}

class OutOfMemory : public FailingDeviceTest, public ::testing::WithParamInterface<const TechniqueInfo*> {
protected:
    /// Lets `count` fail from the first call on, then from the second on, until a call of `draw` needs none of them.
    /// `check` is called after each failure.
    template <class Draw, class Check>
    std::uint64_t fail_at_each(std::atomic<std::uint64_t> Failures::*first, std::uint64_t step, const Draw& draw,
                               const Check& check) {
        std::uint64_t failed = 0;
        for (std::uint64_t n = 1;; n += step) {
            SCOPED_TRACE(n);
            stop_failing();
            failures().*first = n;
            try {
                draw(n);
                stop_failing();
                return failed;
            } catch (const Error& error) {
                ++failed;
                stop_failing();
                expect_one_line(error, "memory");
            }
            check(n);
            if (HasFailure()) return failed;
        }
    }
};

TEST_P(OutOfMemory, IsOneErrorAndTheNextCallWorks) {
    Renderer renderer(validated());
    if (const std::string lacking = renderer.lacking(*GetParam()); !lacking.empty())
        GTEST_SKIP() << "the device lacks " << lacking;
    const Scene scene = table_scene();
    renderer.set_scene(scene);
    std::map<std::uint32_t, std::vector<float>> expected;
    // Sizes that alternate, so that images are allocated anew.
    const auto width_of = [](std::uint64_t n) { return 24u + 4u * std::uint32_t(n % 2); };
    for (const std::uint64_t n : {0, 1, 0, 1})
        expected[width_of(n)] = renderer.render(settings_of(GetParam()->name, width_of(n))).radiance.pixels;
    std::int64_t live = 0;
    bool has_scene = true;
    const auto draw = [&](std::uint64_t n) {
        has_scene = false;
        renderer.set_scene(scene);
        has_scene = true;
        renderer.render(settings_of(GetParam()->name, width_of(n)));
    };
    const auto check = [&](std::uint64_t n) {
        if (!has_scene) {
            renderer.render(settings_of(GetParam()->name, width_of(n)));  // of no scene, or the old one
            renderer.set_scene(scene);
        }
        EXPECT_EQ(renderer.render(settings_of(GetParam()->name, width_of(n))).radiance.pixels, expected[width_of(n)]);
        if (n == 2) live = failures().live;
        if (n > 2 && n % 2 == 0) {
            EXPECT_LE(failures().live, live + 16) << "allocations of failed calls stay";
        }
    };
    EXPECT_GT(fail_at_each(&Failures::first_allocation, 1, draw, check), 10u);
    EXPECT_GT(fail_at_each(&Failures::first_object, 7, draw, check), 10u);
    expect_silent(renderer.validation_messages());
}

std::string test_name(const ::testing::TestParamInfo<const TechniqueInfo*>& tested) {
    std::string name(tested.param->name);
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Each, OutOfMemory, ::testing::ValuesIn(techniques().begin(), techniques().end()), test_name);

class Failing : public FailingDeviceTest {};

TEST_F(Failing, RenderersThatCannotBeMadeLeaveNothing) {
    for (const auto first : {&Failures::first_allocation, &Failures::first_object}) {
        for (std::uint64_t n = 1;; n += 3) {
            SCOPED_TRACE(n);
            stop_failing();
            failures().live = 0;
            failures().*first = n;
            try {
                Renderer{validated()};
                break;
            } catch (const Error& error) {
                expect_one_line(error, "memory");
            }
            EXPECT_EQ(failures().live, 0);
        }
    }
}

TEST_F(Failing, LostDevicesNeedANewRenderer) {
    const Scene scene = table_scene();
    const RenderSettings settings = settings_of("visibility-layers");
    std::vector<float> expected;
    std::uint64_t submissions = 0;
    {
        Renderer renderer(validated());
        renderer.set_scene(scene);
        stop_failing();
        expected = renderer.render(settings).radiance.pixels;
        submissions = failures().submissions;
    }
    ASSERT_GT(submissions, 1u);
    for (std::uint64_t n = 1; n <= submissions; n += 4) {
        SCOPED_TRACE(n);
        stop_failing();
        Renderer renderer(validated());
        renderer.set_scene(scene);
        failures().submissions = 0;
        failures().first_submission = n;
        for (int call = 0; call < 2; ++call) {
            try {
                renderer.render(settings);
                ADD_FAILURE() << "the loss went unnoticed";
            } catch (const DeviceError& error) {
                expect_one_line(error, "new Renderer");
            }
        }
        expect_silent(renderer.validation_messages());
    }
    stop_failing();
    Renderer renderer(validated());
    renderer.set_scene(scene);
    failures().lose_in_wait = true;
    EXPECT_THROW(renderer.render(settings), DeviceError);
    EXPECT_THROW(renderer.set_environment(Environment{}), DeviceError);
    stop_failing();
    Renderer next(validated());
    next.set_scene(scene);
    EXPECT_EQ(next.render(settings).radiance.pixels, expected);
}

}  // namespace
}  // namespace pellucid::test
