#include <pellucid/error.h>
#include <pellucid/measure.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace pellucid {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr PixelFootprint kFootprint{.at_eye = 0.01f, .per_metre = 0.001f};

RefractedPath path(glm::vec3 direction, std::uint16_t events = 2, std::uint16_t reflections = 0) {
    RefractedPath result;
    result.direction = direction;
    result.events = events;
    result.reflections = reflections;
    return result;
}

/// At `degrees` from -Z.
glm::vec3 tilted(double degrees) {
    const double radians = degrees * std::numbers::pi / 180.0;
    return {float(std::sin(radians)), 0.0f, float(-std::cos(radians))};
}

RefractedPath ending(std::int32_t object, glm::vec3 position, float length = 0.0f) {
    RefractedPath result = path({0, 0, -1});
    result.object = object;
    result.position = position;
    result.length = length;
    return result;
}

const RefractedPath kStraight = path({0, 0, -1});
const RefractedPath kNotCovered = path({0, 0, -1}, 0);

float error(const RefractedPath& exact, const RefractedPath& candidate) {
    return path_error_deg(exact, candidate, kFootprint);
}

TEST(PathError, AngleBetweenDirections) {
    EXPECT_EQ(error(kStraight, kStraight), 0.0f);
    for (const double degrees : {90.0, 179.0, 180.0})
        EXPECT_NEAR(error(kStraight, path(tilted(degrees))), degrees, 1e-4);
    // The arc cosine of floats would be 0 or 0.03 here.
    for (const double degrees : {1e-4, 1e-3, 0.01, 1.0})
        EXPECT_NEAR(error(kStraight, path(tilted(degrees))), degrees, 1e-4 * degrees);
}

TEST(PathError, OnlyWhereCovered) { EXPECT_EQ(error(kNotCovered, kStraight), -1.0f); }

TEST(PathError, WithoutAnAnswer) {
    EXPECT_EQ(error(kStraight, kNotCovered), 180.0f);
    for (const Status status : {Status::kMissingLayer, Status::kLeftScreen, Status::kStepLimit, Status::kEventLimit}) {
        RefractedPath given_up = kStraight;
        given_up.status = status;
        EXPECT_EQ(error(kStraight, given_up), 180.0f);
    }
    EXPECT_EQ(error(kStraight, path(glm::vec3(0.0f))), 180.0f);
    EXPECT_EQ(error(kStraight, path({0.0f, kNan, 0.0f})), 180.0f);
    EXPECT_EQ(error(kStraight, path({0.0f, std::numeric_limits<float>::infinity(), 0.0f})), 180.0f);
}

// After K events the exact path has no end either: one cut at the same place agrees with it.
TEST(PathError, BothCut) {
    RefractedPath exact = path({0, 0, -1}, 16), other = path(tilted(0.5), 16);
    exact.status = Status::kEventLimit;
    other.status = Status::kEventLimit;
    EXPECT_NEAR(error(exact, other), 0.5, 1e-4);
    other.direction = tilted(30.0);
    EXPECT_NEAR(error(exact, other), 30.0, 1e-4);
    other = exact;
    other.events = 3;  // given up earlier
    EXPECT_EQ(error(exact, other), 180.0f);
    for (const Status status : {Status::kMissingLayer, Status::kLeftScreen, Status::kStepLimit}) {
        other = exact;
        other.status = status;
        EXPECT_EQ(error(exact, other), 180.0f);
    }
}

TEST(PathError, OpaqueEnds) {
    const RefractedPath exact = ending(3, {1, 2, 3}, 10.0f);  // footprint 0.01 + 10 * 0.001
    EXPECT_EQ(error(exact, ending(3, {1.0f, 2.0f, 3.019f}, 99.0f)), 0.0f);
    EXPECT_EQ(error(exact, ending(3, {1.0f, 2.0f, 3.021f}, 99.0f)), 180.0f);
    EXPECT_EQ(error(exact, ending(2, {1, 2, 3})), 180.0f);
    EXPECT_EQ(error(exact, ending(-1, {1, 2, 3})), 180.0f);
    EXPECT_EQ(error(exact, ending(3, {1.0f, kNan, 3.0f})), 180.0f);
    EXPECT_EQ(error(kStraight, ending(3, {0, 0, 0})), 180.0f);
    // Where the ends agree, directions are not looked at.
    RefractedPath bent = exact;
    bent.direction = tilted(40.0);
    EXPECT_EQ(error(exact, bent), 0.0f);
}

TEST(PathErrorImage, OneValuePerPath) {
    const std::vector<RefractedPath> exact = {kStraight, kNotCovered, kStraight, kStraight, kStraight, kStraight};
    std::vector<RefractedPath> candidate(6, kStraight);
    candidate[3] = path(tilted(90.0));
    const Image image = path_error_image(3, 2, exact, candidate, kFootprint);
    ASSERT_EQ((std::array{image.width, image.height, image.channels}), (std::array{3, 2, 1}));
    EXPECT_EQ(*image.at(1, 0), -1.0f);
    EXPECT_EQ(*image.at(2, 0), 0.0f);
    EXPECT_NEAR(*image.at(0, 1), 90.0f, 1e-4f);
    EXPECT_THROW(path_error_image(3, 3, exact, candidate, kFootprint), Error);
    candidate.pop_back();
    EXPECT_THROW(path_error_image(3, 2, exact, candidate, kFootprint), Error);
}

/// Ten pixels: two without glass, and errors of 0, 0.5, 1.001, 4.9, 5.001, 20, 180 (given up), 0.
class Accuracy : public testing::Test {
protected:
    void add(const RefractedPath& exact_path, const RefractedPath& candidate_path, bool is_stable) {
        exact.push_back(exact_path);
        candidate.push_back(candidate_path);
        stable.push_back(is_stable ? 1 : 0);
    }
    void SetUp() override {
        RefractedPath given_up = kStraight;
        given_up.status = Status::kStepLimit;
        add(kNotCovered, path(tilted(90.0)), true);
        add(path({0, 0, -1}, 1), kStraight, true);
        add(path({0, 0, -1}, 2), path(tilted(0.5)), true);
        add(path({0, 0, -1}, 3), path(tilted(1.001)), false);
        add(path({0, 0, -1}, 4, 1), path(tilted(4.9)), true);
        add(path({0, 0, -1}, 4), path(tilted(5.001)), false);
        add(path({0, 0, -1}, 5, 3), path(tilted(20.0)), false);
        add(path({0, 0, -1}, 16, 14), given_up, false);
        add(path({0, 0, -1}, 6, 1), kStraight, true);
        add(kNotCovered, given_up, false);
    }
    PathAccuracy accuracy() const {
        return path_accuracy(exact, candidate, path_error_image(5, 2, exact, candidate, kFootprint), stable);
    }

    std::vector<RefractedPath> exact, candidate;
    std::vector<std::uint8_t> stable;
};

TEST_F(Accuracy, Shares) {
    const PathAccuracy a = accuracy();
    EXPECT_EQ(a.covered, 8u);
    EXPECT_DOUBLE_EQ(a.within_1deg, 3.0 / 8.0);
    EXPECT_DOUBLE_EQ(a.within_5deg, 5.0 / 8.0);
    EXPECT_DOUBLE_EQ(a.stable_share, 4.0 / 8.0);
    EXPECT_DOUBLE_EQ(a.within_1deg_stable, 3.0 / 4.0);
}

TEST_F(Accuracy, Percentiles) {
    const PathAccuracy a = accuracy();
    EXPECT_NEAR(a.median_deg, 1.001, 1e-3);  // the fourth of eight: 0, 0, 0.5, 1.001, ...
    EXPECT_EQ(a.p95_deg, 180.0);
}

TEST_F(Accuracy, Status) {
    const PathAccuracy a = accuracy();
    EXPECT_EQ(a.status, (std::array{7.0 / 8.0, 0.0, 0.0, 1.0 / 8.0, 0.0}));
}

TEST_F(Accuracy, Groups) {
    const PathAccuracy a = accuracy();
    const auto expect = [](const GroupAccuracy& group, double share, double within) {
        EXPECT_DOUBLE_EQ(group.share, share);
        EXPECT_DOUBLE_EQ(group.within_1deg, within);
    };
    expect(a.two_events, 2.0 / 8.0, 1.0);
    expect(a.four_events, 3.0 / 8.0, 0.0);
    expect(a.more_events, 3.0 / 8.0, 1.0 / 3.0);
    expect(a.with_tir, 4.0 / 8.0, 1.0 / 4.0);
}

TEST_F(Accuracy, Sizes) {
    const Image errors = path_error_image(5, 2, exact, candidate, kFootprint);
    EXPECT_THROW(path_accuracy(exact, candidate, Image(3, 3, 1), stable), Error);
    stable.pop_back();
    EXPECT_THROW(path_accuracy(exact, candidate, errors, stable), Error);
}

void expect_nothing_wrong(const PathAccuracy& a) {
    EXPECT_EQ(a.covered, 0u);
    for (const double share : {a.within_1deg, a.within_5deg, a.stable_share, a.within_1deg_stable})
        EXPECT_EQ(share, 1.0);
    for (const GroupAccuracy& group : {a.two_events, a.four_events, a.more_events, a.with_tir}) {
        EXPECT_EQ(group.share, 0.0);
        EXPECT_EQ(group.within_1deg, 1.0);
    }
    EXPECT_EQ(a.median_deg, 0.0);
    EXPECT_EQ(a.p95_deg, 0.0);
    for (const double share : a.status) EXPECT_EQ(share, 0.0);
}

TEST(AccuracyOfNothing, NoGlassOrNoPixels) {
    const std::vector<RefractedPath> paths(4, kNotCovered);
    const std::vector<std::uint8_t> stable(4, 1);
    expect_nothing_wrong(path_accuracy(paths, paths, path_error_image(2, 2, paths, paths, kFootprint), stable));
    expect_nothing_wrong(path_accuracy({}, {}, Image(0, 0, 1), {}));
}

TEST(AccuracyOfNothing, NoStablePixel) {
    const std::vector<RefractedPath> exact(4, kStraight), candidate(4, path(tilted(20.0)));
    const std::vector<std::uint8_t> stable(4, 0);
    const PathAccuracy a =
        path_accuracy(exact, candidate, path_error_image(2, 2, exact, candidate, kFootprint), stable);
    EXPECT_EQ(a.stable_share, 0.0);
    EXPECT_EQ(a.within_1deg_stable, 1.0);
    EXPECT_EQ(a.within_1deg, 0.0);
    EXPECT_EQ(a.with_tir.share, 0.0);
    EXPECT_EQ(a.with_tir.within_1deg, 1.0);
}

TEST(Mean, OverTheMask) {
    Image image(3, 2, 1);
    image.pixels = {1, 2, 3, 4, 5, 9};
    EXPECT_DOUBLE_EQ(mean(image), 4.0);
    EXPECT_DOUBLE_EQ(mean(image, std::vector<std::uint8_t>{0, 1, 0, 0, 255, 0}), 3.5);
    EXPECT_EQ(mean(image, std::vector<std::uint8_t>(6, 0)), 0.0);
    EXPECT_EQ(mean(Image(0, 0, 1)), 0.0);
    EXPECT_THROW(mean(image, std::vector<std::uint8_t>(5, 1)), Error);
    EXPECT_THROW(mean(Image(3, 2, 3)), Error);
}

TEST(Rmse, OverTheMaskAndChannels) {
    Image a(2, 1, 3), b(2, 1, 3);
    a.pixels = {0, 0, 0, 1, 1, 1};
    b.pixels = {0, 3, 0, 1, 1, -5};
    EXPECT_DOUBLE_EQ(rmse(a, b), std::sqrt((9.0 + 36.0) / 6.0));
    EXPECT_DOUBLE_EQ(rmse(a, b, std::vector<std::uint8_t>{1, 0}), std::sqrt(9.0 / 3.0));
    EXPECT_DOUBLE_EQ(rmse(a, b, std::vector<std::uint8_t>{0, 1}), std::sqrt(36.0 / 3.0));
    EXPECT_EQ(rmse(a, b, std::vector<std::uint8_t>{0, 0}), 0.0);
    EXPECT_EQ(rmse(a, a), 0.0);
    EXPECT_THROW(rmse(a, b, std::vector<std::uint8_t>(3, 1)), Error);
    for (const Image& other : {Image(1, 1, 3), Image(2, 2, 3), Image(2, 1, 1)}) EXPECT_THROW(rmse(a, other), Error);
}

TEST(Spread, NearestRank) {
    const auto expect = [](std::vector<double> values, double median, double p95) {
        const Spread s = spread(std::move(values));
        EXPECT_EQ(s.median, median);
        EXPECT_EQ(s.p95, p95);
    };
    expect({7}, 7, 7);
    expect({2, 1}, 1, 2);
    expect({3, 1, 2}, 2, 3);
    expect({4, 3, 1, 2}, 2, 4);
    std::vector<double> twenty, twenty_one;
    for (int i = 20; i > 0; --i) twenty.push_back(i);
    expect(twenty, 10, 19);
    twenty_one = twenty;
    twenty_one.push_back(21);
    expect(twenty_one, 11, 20);
    expect({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, 6, 12);
    EXPECT_THROW(spread({}), Error);
}

TEST(Spread, NoNumberIsInfinite) {
    const Spread s = spread({std::numeric_limits<double>::quiet_NaN(), 1.0, 2.0, 3.0});
    EXPECT_EQ(s.median, 2.0);
    EXPECT_EQ(s.p95, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace pellucid
