#include "viewer/saved_state.h"

#include <gmock/gmock.h>

#include <cstdlib>

namespace pellucid::viewer {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(SavedState, ComesBackAsItWas) {
    SavedState state;
    state.scene = "shape:gem";
    state.width = 800;
    state.height = 450;
    state.panels = false;
    Look& look = state.look;
    look.technique = "wang-2014";
    look.other = "exact";
    look.divider = 0.3f;
    look.parameters = {{"steps", 12.0}};
    look.view = View::kAnalysis;
    look.samples = 33;
    look.tonemap = ToneMap::kAces;
    look.exposure_ev = -1.25f;
    look.transport = LightTransport::kDirect;
    look.shadows = Shadows::kTinted;
    look.environment = "maps/a b.hdr";
    look.environment_rotation_deg = 90.5;
    look.camera = {{0.1f, 0.2f, 0.3f}, 12.5f, -33.0f, 2.7f, 44.0f};
    look.materials = {{1.7f, 0.1f, 0.2f, {0.1f, 0.9f, 0.5f}, 0.03f, {1, 1, 0.5f}}, {}};
    look.lights = {{{1, 2, 3}, {4, 5, 6}, {0, -1, 0}, 0.5f}};
    look.animation = 2;
    look.time_s = 1.5;
    const SavedState back = from_json(to_json(state));
    EXPECT_EQ(back.look, look);
    EXPECT_EQ(back.scene, state.scene);
    EXPECT_EQ(back.width, 800u);
    EXPECT_EQ(back.height, 450u);
    EXPECT_FALSE(back.panels);
}

TEST(SavedState, RefusesOtherText) {
    for (const char* text : {"", "[]", "{}", "null", R"({"format": 99})", R"({"format": 1, "scene": 3})"})
        EXPECT_THROW(from_json(text), Error) << text;
    std::string unknown = to_json({});
    unknown.replace(unknown.find("\"neutral\""), 9, "\"nonsense\"");
    EXPECT_THAT([&] { from_json(unknown); }, ThrowsMessage<Error>(HasSubstr("nonsense")));
}

TEST(SavedState, LiesInTheFolderOfTheStandard) {
    setenv("XDG_STATE_HOME", "/somewhere", 1);
    EXPECT_EQ(state_file(), "/somewhere/pellucid/viewer.json");
    unsetenv("XDG_STATE_HOME");
    setenv("HOME", "/home/one", 1);
    EXPECT_EQ(state_file(), "/home/one/.local/state/pellucid/viewer.json");
}

}  // namespace
}  // namespace pellucid::viewer
