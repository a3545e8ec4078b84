#include "viewer/frame_pace.h"

#include <gtest/gtest.h>

namespace pellucid::viewer {
namespace {

/// A device whose frames take a time per pixel and one per frame.
Pace settle(FramePace& pace, double full_ms, double coarse_ms, double fixed_ms, int frames = 100) {
    for (int i = 0; i < frames; ++i) {
        const Pace now = pace.pace();
        const double area = double(now.scale) * double(now.scale);
        pace.measured(fixed_ms + area * (now.coarse ? coarse_ms : full_ms));
    }
    return pace.pace();
}

TEST(FramePace, DrawsInFullWhereThatIsFast) {
    FramePace pace(50.0);
    pace.restart(true);
    EXPECT_EQ(settle(pace, 20.0, 10.0, 1.0), (Pace{1.0f, false}));
}

TEST(FramePace, DropsTheResolutionFirst) {
    FramePace pace(50.0);
    pace.restart(true);
    const Pace settled = settle(pace, 150.0, 60.0, 5.0);
    EXPECT_FALSE(settled.coarse);
    EXPECT_FLOAT_EQ(settled.scale, 0.5f);
}

TEST(FramePace, DropsTheTechniqueWhereLittleWouldBeLeft) {
    FramePace pace(50.0);
    pace.restart(true);
    const Pace settled = settle(pace, 2000.0, 100.0, 5.0);
    EXPECT_TRUE(settled.coarse);
    EXPECT_FLOAT_EQ(settled.scale, 0.5f);
}

TEST(FramePace, HasNoOtherTechniqueThanFast) {
    FramePace pace(50.0);
    pace.restart(false);
    const Pace settled = settle(pace, 2000.0, 100.0, 1.0);
    EXPECT_FALSE(settled.coarse);
    EXPECT_LT(settled.scale, 0.375f);
}

TEST(FramePace, DoesNotSwing) {
    FramePace pace(50.0);
    pace.restart(true);
    const Pace settled = settle(pace, 60.0, 40.0, 2.0);
    for (int i = 0; i < 50; ++i) EXPECT_EQ(settle(pace, 60.0, 40.0, 2.0, 1), settled);
}

TEST(FramePace, IgnoresOneSlowFrame) {
    FramePace pace(50.0);
    pace.restart(true);
    const Pace settled = settle(pace, 20.0, 10.0, 1.0);
    pace.measured(2000.0);
    EXPECT_EQ(pace.pace(), settled);
}

TEST(FramePace, HasAtLeastOnePixel) {
    EXPECT_EQ(scaled(1, 0.125f), 1u);
    EXPECT_EQ(scaled(960, 0.5f), 480u);
    EXPECT_EQ(scaled(541, 1.0f), 541u);
}

}  // namespace
}  // namespace pellucid::viewer
