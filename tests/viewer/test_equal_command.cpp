#include "viewer/equal_command.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace pellucid::viewer {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

struct EqualCommandTest : ::testing::Test {
    EqualCommandTest() {
        look = look_of(scene);
        look.camera = framing_orbit(scene_bounds(scene), 640, 360);
    }
    EqualCommand command() const { return equal_command(look, scene, how, 640, 360); }

    Scene scene = load_scene("shape:goblet");
    Look look;
    cli::SceneArguments how;
};

TEST_F(EqualCommandTest, SaysWhatIsSeen) {
    look.technique = "wang-2014";
    look.parameters = {{"steps", 12.0}};
    look.exposure_ev = 0.5f;
    look.environment = "sky";
    const EqualCommand made = command();
    EXPECT_THAT(made.line, HasSubstr("pellucid render shape:goblet -o image.png --size 640x360 --technique wang-2014"));
    for (const char* words :
         {"--steps 12", "--samples 16", "--exposure 0.5", "--environment sky", "--camera orbit:0,15,"})
        EXPECT_THAT(made.line, HasSubstr(words));
    EXPECT_THAT(made.lacking, IsEmpty());
}

TEST_F(EqualCommandTest, LeavesOutDefaults) {
    for (const char* words : {"--exposure", "--tonemap", "--environment", "--fov", "--ior", "--light", "--time"})
        EXPECT_THAT(command().line, Not(HasSubstr(words)));
}

TEST_F(EqualCommandTest, NamesTheTargetWhereItIsNotTheCentre) {
    look.camera.target += glm::vec3(0.5f, 0.0f, 0.0f);
    const std::string line = command().line;
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 5) << line;
}

TEST_F(EqualCommandTest, SaysWhatAllGlassHasInCommon) {
    for (MaterialLook& material : look.materials) {
        material.ior = 1.7f;
        material.attenuation_color = {0.5f, 0.25f, 1.0f};
        material.attenuation_distance = 0.125f;
    }
    const EqualCommand made = command();
    EXPECT_THAT(made.line, HasSubstr("--ior 1.7 --attenuation-color 0.5,0.25,1 --attenuation-distance 0.125"));
    EXPECT_THAT(made.lacking, IsEmpty());
}

TEST_F(EqualCommandTest, ConfessesWhatItLacks) {
    look.materials.front().roughness = 0.4f;
    look.other = "exact";
    const EqualCommand made = command();
    EXPECT_THAT(made.lacking, Contains(HasSubstr("material 0")));
    EXPECT_THAT(made.lacking, Contains(HasSubstr("right of the divider")));
}

TEST_F(EqualCommandTest, KeepsTheOptionsOfLoading) {
    how.ior = 1.4;
    how.translucency.lights = {"sun:30,40"};
    EXPECT_THAT(command().line, HasSubstr("--add-light sun:30,40"));
    EXPECT_THAT(command().line, HasSubstr("--ior 1.4"));
}

TEST(ShellWord, QuotesWhatAShellWouldRead) {
    EXPECT_EQ(shell_word("a/b-c_d.obj"), "a/b-c_d.obj");
    EXPECT_EQ(shell_word("a b"), "'a b'");
    EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
    EXPECT_EQ(shell_word("$HOME;rm"), "'$HOME;rm'");
    EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace pellucid::viewer
