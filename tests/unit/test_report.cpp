#include "report/color_scale.h"
#include "report/frontier.h"
#include "report/report.h"
#include "report/worst_region.h"
#include "test_files.h"

#include <pellucid/error.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <set>

namespace pellucid {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using test::content_of;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

Image filled(int width, int height, int channels, float value) {
    Image image(width, height, channels);
    std::fill(image.pixels.begin(), image.pixels.end(), value);
    return image;
}

ordered_json run(const std::string& scene, const std::string& technique, double within_1deg, double frame_ms) {
    return {
        {"scene", scene}, {"technique", technique}, {"view", 0}, {"within_1deg", within_1deg}, {"frame_ms", frame_ms}};
}

/// What the page is given: data.js without the assignment around it.
ordered_json data_of(const fs::path& folder) {
    const std::string text = content_of(folder / "data.js");
    const std::size_t begin = text.find('{');
    return ordered_json::parse(text.substr(begin, text.rfind('}') + 1 - begin));
}

std::string error_of(const std::function<void()>& action) {
    try {
        action();
        return {};
    } catch (const Error& error) {
        return error.what();
    }
}

/// All files below a folder, with '/' between names.
std::set<std::string> files_in(const fs::path& folder) {
    std::set<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) files.insert(entry.path().lexically_relative(folder).generic_string());
    }
    return files;
}

TEST(Report, WritesPicturesAtOnceAndThePageLast) {
    const TemporaryFolder folder;
    Report report(folder / "a/b");
    report.add_picture({"shape:cube", 0, ""}, PictureKind::kImage, filled(40, 20, 3, 0.5f));
    report.add_picture({"shape:cube", 0, "fast"}, PictureKind::kError, filled(40, 20, 1, 3.0f));
    report.add_run(run("shape:cube", "fast", 0.75, 2.0));
    EXPECT_THAT(files_in(folder / "a/b"),
                ElementsAre("pellucid-report.txt", "pictures/shape_cube-view0-exact-image.png",
                            "pictures/shape_cube-view0-fast-error.png"));
    EXPECT_THAT(content_of(folder / "a/b/pellucid-report.txt"),
                HasSubstr("pictures/shape_cube-view0-fast-error.png\n"));
    EXPECT_EQ(report.finish({"a device", "a driver", "1.2.3", "pellucid compare", "rays"}), folder / "a/b/index.html");
    EXPECT_THAT(files_in(folder / "a/b"), testing::IsSupersetOf({"index.html", "report.css", "report.js", "data.js",
                                                                 "frontier.svg", "pellucid-report.txt"}));
    EXPECT_THAT(content_of(folder / "a/b/index.html"), HasSubstr("</html>"));
    const ordered_json data = data_of(folder / "a/b");
    EXPECT_EQ(data["header"]["device"], "a device");
    EXPECT_EQ(data["runs"][0], run("shape:cube", "fast", 0.75, 2.0));
    EXPECT_EQ(data["pictures"][0]["width"], 40);
    EXPECT_FALSE(data["pictures"][0].contains("worst"));
    EXPECT_EQ(data["pictures"][1]["worst"]["mean"], 3.0);
}

TEST(Report, WithoutItsDataThereIsNoPage) {
    for (const char* file : {"data.js", "report.css", "report.js", "frontier.svg"}) {
        const TemporaryFolder folder;
        Report report(folder.path());
        report.add_run(run("s", "t", 0.75, 2.0));
        fs::create_directory(folder / file);  // cannot be written any more
        EXPECT_THAT(error_of([&] { report.finish({}); }), HasSubstr(file));
        EXPECT_FALSE(fs::exists(folder / "index.html"));
    }
}

TEST(Report, ThePageNeedsNothingFromElsewhere) {
    const TemporaryFolder folder;
    Report report(folder / "a");
    report.finish({});
    for (const char* file : {"index.html", "report.css", "report.js"}) {
        const std::string text = content_of(folder / "a" / file);
        for (const char* elsewhere :
             {"http:", "https:", "//cdn", "@import", "fetch(", "XMLHttpRequest", "type=\"module\""})
            EXPECT_THAT(text, Not(HasSubstr(elsewhere))) << file;
    }
}

TEST(Report, NamesMayHoldAnything) {
    const TemporaryFolder folder;
    const std::string hostile = "a/<script>alert('\"&\n\x01\xff\xe2\x80\xa8/.. \xc3\xa9.obj";
    Report report(folder / "a");
    report.add_picture({hostile, 0, "../../up"}, PictureKind::kImage, filled(4, 4, 3, 0.5f));
    report.add_picture({std::string(5000, 'x'), -1, ".."}, PictureKind::kImage, filled(4, 4, 3, 0.5f));
    report.add_picture({"", 0, "/"}, PictureKind::kImage, filled(4, 4, 3, 0.5f));
    report.add_run(run(hostile, hostile, 0.5, 1.0));
    report.finish({hostile, hostile, hostile, hostile, hostile});

    EXPECT_EQ(folder.size(), 1u) << "a file outside the folder";
    for (const std::string& file : files_in(folder / "a")) {
        EXPECT_EQ(file.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-_./"), file.npos) << file;
        EXPECT_LT(file.size(), 120u);
    }
    const std::string script = content_of(folder / "a/data.js");
    EXPECT_TRUE(std::all_of(script.begin(), script.end(), [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); }));
    const ordered_json data = data_of(folder / "a");
    EXPECT_EQ(data["pictures"][0]["scene"], data["runs"][0]["scene"]);
    EXPECT_THAT(data["runs"][0]["scene"], HasSubstr("\xef\xbf\xbd")) << "U+FFFD for what is no UTF-8";
    const std::string plot = content_of(folder / "a/frontier.svg");
    EXPECT_THAT(plot, HasSubstr("\xef\xbf\xbd"));
    EXPECT_THAT(plot, HasSubstr("&lt;script&gt;"));
    EXPECT_THAT(plot, Not(HasSubstr("<script>")));
    EXPECT_EQ(plot.find('\x01'), plot.npos);
}

TEST(Report, EveryPictureHasAFileOfItsOwn) {
    const TemporaryFolder folder;
    Report report(folder / "a");
    // Alike in their last part, where upper case does not count, or in the characters that are kept.
    for (const char* scene : {"one/bunny.obj", "two/bunny.obj", "BUNNY.OBJ", "bunny:obj"})
        report.add_picture({scene, 0, "fast"}, PictureKind::kImage, filled(4, 4, 3, 0.5f));
    report.finish({});
    const ordered_json data = data_of(folder / "a");
    std::set<std::string> files;
    for (const ordered_json& picture : data["pictures"]) {
        files.insert(picture["file"]);
        EXPECT_TRUE(fs::exists(folder / "a" / picture["file"].get<std::string>()));
    }
    EXPECT_EQ(files.size(), 4u);
}

TEST(Report, ReplacesAnOlderOneAndNothingElse) {
    const TemporaryFolder folder;
    {
        Report older(folder.path());
        older.add_picture({"old", 0, "fast"}, PictureKind::kImage, filled(4, 4, 3, 0.5f));
        older.add_run(run("old", "fast", 0.5, 1.0));
        older.finish({});
    }
    folder.file("notes.txt", "mine");
    folder.file("pictures/mine.png", "mine");
    folder.file("pictures/new-view0-fast-image.png", "mine, of a name that the report would take");
    {
        Report newer(folder.path());
        EXPECT_THAT(files_in(folder.path()), ElementsAre("notes.txt", "pellucid-report.txt", "pictures/mine.png",
                                                         "pictures/new-view0-fast-image.png"))
            << "no page while the new one is not ready";
        newer.add_picture({"new", 0, "fast"}, PictureKind::kImage, filled(4, 4, 3, 0.5f));
    }  // killed: its picture is left without a page
    Report last(folder.path());
    last.finish({});
    EXPECT_THAT(files_in(folder.path()),
                ElementsAre("data.js", "index.html", "notes.txt", "pellucid-report.txt", "pictures/mine.png",
                            "pictures/new-view0-fast-image.png", "report.css", "report.js"));
    EXPECT_THAT(content_of(folder / "pictures/new-view0-fast-image.png"), HasSubstr("mine"));
}

TEST(Report, RefusesWhatItWouldOverwrite) {
    const TemporaryFolder folder;
    folder.file("index.html", "my own page");
    EXPECT_THAT(error_of([&] { Report report(folder.path()); }), HasSubstr("index.html: is in the way"));
    EXPECT_EQ(content_of(folder / "index.html"), "my own page");
    folder.file("plain", "a file");
    EXPECT_THAT(error_of([&] { Report report(folder / "plain"); }), HasSubstr("plain"));
    EXPECT_THAT(error_of([&] { Report report(folder / "plain/below"); }), HasSubstr("plain/below"));
    fs::create_directory(folder / "b");
    folder.file("b/pellucid-report.txt", "something else\n");
    EXPECT_THAT(error_of([&] { Report report(folder / "b"); }), HasSubstr("is not the file list of a report"));
}

TEST(Report, AListLeadsNowhereElse) {
    const TemporaryFolder folder;
    { Report report(folder / "a"); }
    folder.file("outside", "mine");
    std::ofstream(folder / "a/pellucid-report.txt", std::ios::app) << "../outside\n"
                                                                   << (folder / "outside").string() << "\n";
    { Report report(folder / "a"); }
    EXPECT_TRUE(fs::exists(folder / "outside"));
}

TEST(Report, MapsAreColoured) {
    const TemporaryFolder folder;
    Report report(folder / "a");
    Image error(3, 1, 1);
    error.pixels = {-1.0f, 0.0f, 180.0f};
    report.add_picture({"s", 0, "t"}, PictureKind::kError, error);
    const Image shown = read_image(folder / "a/pictures/s-view0-t-error.png");
    const ColorScale scale;
    const glm::vec3 expected[] = {kUncoveredColor, scale.at(0.0f), scale.at(1.0f)};
    for (int x = 0; x < 3; ++x)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(shown.at(x, 0)[c], expected[x][c], 0.5f / 255.0f);
}

/// Relative luminance (WCAG 2) of an sRGB-encoded colour.
float luminance(glm::vec3 color) {
    const auto linear = [](float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); };
    return 0.2126f * linear(color.r) + 0.7152f * linear(color.g) + 0.0722f * linear(color.b);
}

TEST(ColorScale, GrowsBrighterWithoutLeavingTheGamut) {
    const ColorScale scale;
    float before = luminance(kUncoveredColor);
    for (int i = 0; i < 256; ++i) {
        const glm::vec3 color = scale.at(float(i) / 255.0f);
        EXPECT_GT(luminance(color), before) << i;
        EXPECT_GE(glm::min(glm::min(color.r, color.g), color.b), 0.0f) << i;
        EXPECT_LE(glm::max(glm::max(color.r, color.g), color.b), 1.0f) << i;
        before = luminance(color);
    }
}

TEST(ColorScale, IsLogarithmicInDegreesAndClampsWhatIsOutside) {
    EXPECT_EQ(error_share(0.0f), 0.0f);
    EXPECT_NEAR(error_share(0.01f), 0.0f, 1e-6f);
    EXPECT_NEAR(error_share(180.0f), 1.0f, 1e-6f);
    EXPECT_NEAR(error_share(1.0f) - error_share(0.1f), error_share(10.0f) - error_share(1.0f), 1e-5f);
    const ColorScale scale;
    EXPECT_EQ(scale.at(-1.0f), scale.at(0.0f));
    EXPECT_EQ(scale.at(2.0f), scale.at(1.0f));
    EXPECT_EQ(scale.at(kNaN), scale.at(1.0f));
    EXPECT_EQ(hex_color({0.0f, 0.5f, 1.0f}), "#0080ff");
}

TEST(WorstRegion, IsWhereTheMapIsGreatest) {
    Image map = filled(200, 100, 1, -1.0f);
    for (int y = 50; y < 82; ++y)
        for (int x = 120; x < 152; ++x) *map.at(x, y) = 90.0f;
    *map.at(10, 10) = 180.0f;  // greater, but alone
    *map.at(11, 10) = kNaN;
    const std::optional<Region> worst = worst_region(map);
    ASSERT_TRUE(worst);
    EXPECT_EQ(worst->size, 32);
    EXPECT_EQ(worst->x, 120);
    EXPECT_EQ(worst->y, 50);
    EXPECT_DOUBLE_EQ(worst->mean, 90.0);
}

TEST(WorstRegion, AgreesWithTryingEveryPlace) {
    Image map(70, 60, 1);
    std::mt19937 random(1);
    for (float& value : map.pixels) value = float(random() % 1000) - 300.0f;
    Region best;
    for (int y = 0; y + 32 <= map.height; ++y) {
        for (int x = 0; x + 32 <= map.width; ++x) {
            double sum = 0.0;
            for (int i = 0; i < 32 * 32; ++i) sum += std::max(0.0f, *map.at(x + i % 32, y + i / 32));
            if (sum / (32 * 32) > best.mean) best = {x, y, 32, sum / (32 * 32)};
        }
    }
    const std::optional<Region> worst = worst_region(map);
    ASSERT_TRUE(worst);
    EXPECT_EQ(worst->x, best.x);
    EXPECT_EQ(worst->y, best.y);
    EXPECT_NEAR(worst->mean, best.mean, 1e-9);
}

TEST(WorstRegion, FindsCornersAndCopesWithSmallImages) {
    for (const auto& [x, y] : {std::pair{0, 0}, {199, 0}, {0, 99}, {199, 99}}) {
        Image map(200, 100, 1);
        *map.at(x, y) = 1.0f;
        const std::optional<Region> worst = worst_region(map);
        ASSERT_TRUE(worst);
        EXPECT_TRUE(worst->x <= x && x < worst->x + worst->size && worst->x + worst->size <= 200);
        EXPECT_TRUE(worst->y <= y && y < worst->y + worst->size && worst->y + worst->size <= 100);
        EXPECT_DOUBLE_EQ(worst->mean, 1.0 / (32 * 32));
    }
    EXPECT_EQ(worst_region(filled(3, 1, 1, 2.0f))->size, 1);
    EXPECT_FALSE(worst_region(filled(64, 64, 1, -1.0f)));
    EXPECT_FALSE(worst_region(filled(64, 64, 1, 0.0f)));
    EXPECT_EQ(region_size(3840, 2160), 135);
}

TEST(Frontier, HoldsWhatNothingBeats) {
    const std::vector<Performance> candidates = {{4.0, 0.9},  {1.0, 0.5}, {5.0, 0.9}, {2.0, 0.4},
                                                 {9.0, 0.99}, {1.0, 0.5}, {1.0, 0.3}};
    EXPECT_THAT(pareto_frontier(candidates), ElementsAre(1, 5, 0, 4));
    EXPECT_TRUE(pareto_frontier({}).empty());
}

TEST(Frontier, PlotsWhatHasATime) {
    EXPECT_EQ(frontier_svg({}, "right"), "");
    EXPECT_EQ(frontier_svg({{"untimed", {}}}, "right"), "");
    const std::string plot =
        frontier_svg({{"untimed", {}}, {"a&b", {{2.0, 0.5}, {4.0, 1.0}}}, {"never right", {{3.0, 0.0}}}}, "right");
    EXPECT_THAT(plot, HasSubstr("a&amp;b"));
    EXPECT_THAT(plot, HasSubstr("3 ms"));
    EXPECT_THAT(plot, HasSubstr("75.00%"));
    EXPECT_THAT(plot, HasSubstr("no time known"));
    EXPECT_THAT(plot, Not(HasSubstr("nan")));
    EXPECT_THAT(plot, Not(HasSubstr("inf")));
}

TEST(Frontier, OneRunIsEnoughAndTimesMayDifferWidely) {
    for (const double accuracy : {0.0, 0.5, 0.93, 0.9999, 1.0}) {
        for (const double time_ms : {1e-6, 0.7, 1e6}) {
            const std::string plot = frontier_svg({{"a", {{time_ms, accuracy}}}, {"b", {{1.0, accuracy}}}}, "right");
            EXPECT_THAT(plot, Not(HasSubstr("nan")));
            EXPECT_THAT(plot, Not(HasSubstr("inf")));
            EXPECT_THAT(plot, HasSubstr("</svg>"));
        }
    }
}

}  // namespace
}  // namespace pellucid
