#include "core/file.h"
#include "test_files.h"

#include <pellucid/error.h>
#include <pellucid/image.h>

#include <gtest/gtest.h>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

#include <cmath>
#include <random>

namespace pellucid {
namespace {

using test::content_of;
using test::TemporaryFolder;

Image noise(int width, int height, int channels, float low, float high) {
    Image image(width, height, channels);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> value(low, high);
    for (float& p : image.pixels) p = value(random);
    return image;
}

/// Message of the Error that `action` throws; empty if none.
template <typename Action>
std::string error_of(Action&& action) {
    try {
        action();
        return {};
    } catch (const Error& error) {
        return error.what();
    }
}

TEST(ImageFiles, ExrKeepsEveryBit) {
    const TemporaryFolder folder;
    for (const int channels : {1, 2, 3, 4, 6}) {
        const Image image = noise(13, 7, channels, -2.0f, 70000.0f);
        write_image(folder / "a.exr", image);
        const Image back = read_image(folder / "a.exr");
        EXPECT_EQ(back.width, 13);
        EXPECT_EQ(back.height, 7);
        ASSERT_EQ(back.channels, channels);
        EXPECT_EQ(back.pixels, image.pixels);
    }
}

TEST(ImageFiles, ExrKeepsChannelNames) {
    const TemporaryFolder folder;
    write_image(folder / "a.exr", noise(4, 4, 2, 0, 1), {"depth", "normal.x"});
    EXPECT_NE(content_of(folder / "a.exr").find("normal.x"), std::string::npos);
    EXPECT_NE(error_of([&] { write_image(folder / "a.exr", noise(4, 4, 2, 0, 1), {"one"}); }), "");
}

TEST(ImageFiles, PngRoundsTo8BitsAndIsTaggedSrgb) {
    const TemporaryFolder folder;
    for (const int channels : {1, 2, 3, 4}) {
        const Image image = noise(9, 5, channels, 0.0f, 1.0f);
        write_image(folder / "a.png", image);
        const Image back = read_image(folder / "a.png");
        ASSERT_EQ(back.channels, channels);
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            EXPECT_NEAR(back.pixels[i], image.pixels[i], 0.5f / 255.0f + 1e-6f) << "alpha must not be multiplied in";
    }
    EXPECT_NE(content_of(folder / "a.png").find("sRGB"), std::string::npos);
}

TEST(ImageFiles, PngClampsWhatIsOutside) {
    const TemporaryFolder folder;
    Image image(4, 1, 1);
    image.pixels = {-1.0f, 2.0f, NAN, INFINITY};
    write_image(folder / "a.png", image);
    EXPECT_EQ(read_image(folder / "a.png").pixels, (std::vector<float>{0, 1, 0, 1}));
}

TEST(ImageFiles, TheSameImageGivesTheSameBytes) {
    const TemporaryFolder folder;
    const Image image = noise(16, 16, 3, 0, 1);
    for (const char* extension : {".png", ".exr"}) {
        write_image(folder / ("a" + std::string(extension)), image);
        write_image(folder / ("b" + std::string(extension)), image);
        EXPECT_EQ(content_of(folder / ("a" + std::string(extension))),
                  content_of(folder / ("b" + std::string(extension))));
    }
}

TEST(ImageFiles, DecodesFromMemoryWhateverTheName) {
    const TemporaryFolder folder;
    const Image image = noise(8, 8, 4, 0, 1);
    for (const char* name : {"a.png", "a.exr"}) {
        write_image(folder / name, image);
        const std::string bytes = content_of(folder / name);
        const Image back = decode_image(bytes.data(), bytes.size(), "no extension");
        EXPECT_EQ(back.pixels, read_image(folder / name).pixels);
    }
}

TEST(ImageFiles, RefusesWhatIsNoImage) {
    const TemporaryFolder folder;
    EXPECT_NE(error_of([] { decode_image("hello world", 11, "greeting"); }).find("greeting"), std::string::npos);
    EXPECT_NE(error_of([] { decode_image("", 0, "nothing"); }).find("nothing"), std::string::npos);
    EXPECT_NE(error_of([&] { read_image(folder / "missing.png"); }).find("missing.png: no such file"),
              std::string::npos);
    EXPECT_NE(error_of([&] { read_image(folder.path()); }), "");
    for (const char* name : {"text.png", "text.exr", "text.hdr", "text.jpg"})
        EXPECT_NE(error_of([&] { read_image(folder.file(name, "this is no image")); }).find(name), std::string::npos);
    EXPECT_NE(error_of([&] { read_image(folder.file("empty.png", "")); }), "");
}

/// libpng jumps out of OpenImageIO's reader over strings of its own: the leak sanitizer looks away.
struct LibraryLeaks {
#if defined(__SANITIZE_ADDRESS__)
    __lsan::ScopedDisabler disabled;
#endif
};

TEST(ImageFiles, DamagedImagesAreRefusedOrRead) {
    [[maybe_unused]] const LibraryLeaks leaks{};
    const TemporaryFolder folder;
    for (const char* name : {"a.png", "a.exr"}) {
        write_image(folder / name, noise(32, 32, 3, 0, 1));
        const std::string bytes = content_of(folder / name);
        for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 10) {
            const std::string what = error_of([&] { decode_image(bytes.data(), size, "cut"); });
            EXPECT_EQ(what.find('\n'), std::string::npos);
        }
        std::mt19937 random(3);
        for (int round = 0; round < 20; ++round) {
            std::string damaged = bytes;
            damaged[random() % damaged.size()] = static_cast<char>(random());
            error_of([&] { decode_image(damaged.data(), damaged.size(), "damaged"); });
        }
    }
}

TEST(ImageFiles, RefusesGiantImagesBeforeReservingMemory) {
    [[maybe_unused]] const LibraryLeaks leaks{};
    // A PNG header of 32768 x 32768 pixels, with its checksum, and nothing behind it.
    const std::string png("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\x80\0\0\0\x80\0\x08\x02\0\0\0\x4b\x1e\x34\x28", 33);
    EXPECT_NE(error_of([&] { decode_image(png.data(), png.size(), "giant"); }), "");
}

TEST(ImageFiles, FailedWritesSayWhyAndLeaveNothing) {
    const TemporaryFolder folder;
    const Image image = noise(4, 4, 3, 0, 1);
    const std::string missing = error_of([&] { write_image(folder / "no/such/folder/a.png", image); });
    EXPECT_NE(missing.find("a.png"), std::string::npos);
    EXPECT_NE(missing.find("there is no folder"), std::string::npos) << missing;
    folder.file("plain", "a file, not a folder");
    EXPECT_NE(error_of([&] { write_image(folder / "plain/a.png", image); }), "");
    std::filesystem::create_directory(folder / "taken.png");
    EXPECT_NE(error_of([&] { write_image(folder / "taken.png", image); }), "");
    EXPECT_NE(error_of([&] { write_image(folder / "a.tga", image); }).find(".exr, .png"), std::string::npos);
    EXPECT_NE(error_of([&] { write_image(folder / "a.png", Image()); }), "");
    EXPECT_NE(error_of([&] { write_image(folder / "a.png", noise(4, 4, 5, 0, 1)); }), "");
    EXPECT_EQ(folder.size(), 2u) << "something was left behind";
}

TEST(ImageFiles, FailedWriteKeepsTheOldFile) {
    const TemporaryFolder folder;
    folder.file("a.txt", "old");
    const std::string what = error_of([&] {
        write_file_atomically(folder / "a.txt", [](const std::filesystem::path& temporary) {
            std::ofstream(temporary) << "half";
            throw std::runtime_error("disk full");
        });
    });
    EXPECT_NE(what.find("a.txt"), std::string::npos);
    EXPECT_NE(what.find("disk full"), std::string::npos);
    EXPECT_EQ(content_of(folder / "a.txt"), "old");
    EXPECT_EQ(folder.size(), 1u);
    write_text_file(folder / "a.txt", "new");
    EXPECT_EQ(content_of(folder / "a.txt"), "new");
    EXPECT_EQ(folder.size(), 1u);
}

TEST(ImageFiles, UnwritableFolder) {
    const TemporaryFolder folder;
    std::filesystem::permissions(folder.path(),
                                 std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    if (access(folder.path().c_str(), W_OK) == 0) GTEST_SKIP() << "this user may write everywhere";
    EXPECT_NE(error_of([&] { write_image(folder / "a.png", Image(2, 2, 3)); }).find("cannot write into folder"),
              std::string::npos);
    std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
}

TEST(ImageFiles, ReadFileSaysWhatIsWrong) {
    const TemporaryFolder folder;
    EXPECT_NE(error_of([&] { read_file(folder / "missing"); }).find("no such file"), std::string::npos);
    EXPECT_NE(error_of([&] { read_file(folder.path()); }).find("folder"), std::string::npos);
    EXPECT_NE(error_of([&] { read_file(folder / "missing/below"); }), "");
    EXPECT_EQ(read_file(folder.file("a", "abc")).size(), 3u);
    EXPECT_TRUE(read_file(folder.file("b", "")).empty());
}

template <class T>
void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
    std::string bytes = name + '\0' + type + '\0';
    append(bytes, std::int32_t(value.size()));
    return bytes + value;
}

/// An OpenEXR file of one texel, with channels in the order of their names.
std::string exr(const std::vector<std::string>& channels, const std::vector<float>& values,
                const std::vector<float>& chromaticities) {
    std::string list, box, unit, center, colors;
    for (const std::string& channel : channels) {
        list += channel + '\0';
        for (const std::int32_t number : {2, 0, 1, 1}) append(list, number);  // float, sampled at every texel
    }
    list += '\0';
    for (int i = 0; i < 4; ++i) append(box, std::int32_t(0));
    for (int i = 0; i < 2; ++i) append(center, 0.0f);
    append(unit, 1.0f);
    for (const float value : chromaticities) append(colors, value);
    std::string bytes("\x76\x2f\x31\x01\2\0\0\0", 8);
    bytes += attribute("channels", "chlist", list);
    if (!colors.empty()) bytes += attribute("chromaticities", "chromaticities", colors);
    bytes += attribute("compression", "compression", std::string(1, '\0')) + attribute("dataWindow", "box2i", box) +
             attribute("displayWindow", "box2i", box) + attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
             attribute("pixelAspectRatio", "float", unit) + attribute("screenWindowCenter", "v2f", center) +
             attribute("screenWindowWidth", "float", unit) + '\0';
    append(bytes, std::uint64_t(bytes.size() + 8));
    append(bytes, std::int32_t(0));
    append(bytes, std::int32_t(4 * values.size()));
    for (const float value : values) append(bytes, value);
    return bytes;
}

TEST(ImageFiles, ExrColoursBecomeRec709) {
    const TemporaryFolder folder;
    const std::vector<float> rec709 = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
    const std::vector<float> rec2020 = {0.708f, 0.292f, 0.170f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.3290f};
    const std::vector<float> aces = {0.7347f, 0.2653f, 0.0f, 1.0f, 0.0001f, -0.077f, 0.32168f, 0.33767f};
    // Channels are stored as blue, green, red.
    const auto read = [&](const std::vector<float>& bgr, const std::vector<float>& chromaticities) {
        const Image image = read_image(folder.file("a.exr", exr({"B", "G", "R"}, bgr, chromaticities)));
        const std::string bytes = exr({"B", "G", "R"}, bgr, chromaticities);
        EXPECT_EQ(decode_image(bytes.data(), bytes.size(), "a").pixels, image.pixels);
        return image.pixels;
    };
    const std::vector<float> plain = {0.75f, 0.5f, 0.25f};
    EXPECT_EQ(read({0.25f, 0.5f, 0.75f}, {}), plain);
    EXPECT_EQ(read({0.25f, 0.5f, 0.75f}, rec709), plain);
    const std::vector<float> white = read({2.0f, 2.0f, 2.0f}, aces);
    for (const float value : white) EXPECT_NEAR(value, 2.0f, 1e-3f);
    // ITU-R BT.2087 has this matrix the other way around.
    const std::vector<float> green = read({0.0880f, 0.9195f, 0.3293f}, rec2020);
    EXPECT_NEAR(green[0], 0.0f, 2e-3f);
    EXPECT_NEAR(green[1], 1.0f, 2e-3f);
    EXPECT_NEAR(green[2], 0.0f, 2e-3f);
    EXPECT_EQ(read({0.0f, 1.0f, 0.0f}, rec2020)[0], 0.0f) << "beyond Rec.709";
    EXPECT_NE(error_of([&] {
                  read({1, 1, 1}, {0, 0, 0, 0, 0, 0, 0, 0});
              }).find("a.exr: the chromaticities"),
              std::string::npos);
    // Of luminance and chroma.
    const std::string chroma = exr({"BY", "RY", "Y"}, {0, 0, 1}, {});
    EXPECT_NE(error_of([&] { read_image(folder.file("c.exr", chroma)); }).find("c.exr: stores luminance and chroma"),
              std::string::npos);
}

TEST(ImageFiles, ReadsRealPanoramas) {
    const std::filesystem::path folder = test::data_folder() / "hdri";
    if (test::data_folder().empty()) GTEST_SKIP() << "PELLUCID_TEST_DATA does not name a folder";
    EXPECT_EQ(read_image(folder / "nvpro_std_env.hdr").width, 1500);
    EXPECT_EQ(read_image(folder / "royal_esplanade_1k.hdr").width, 1024);
    for (const char* name : {"venice_sunset_1k.exr", "loader_piz_compressed.exr", "loader_uncompressed.exr"})
        EXPECT_GE(read_image(folder / name).channels, 3) << name;
}

}  // namespace
}  // namespace pellucid
