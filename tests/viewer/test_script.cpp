#include "viewer/script.h"

#include <pellucid/error.h>

#include <gmock/gmock.h>

namespace pellucid::viewer {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

TEST(Script, HasWordsQuotesAndComments) {
    const auto lines = parse_script("# all of it\n\nopen \"a b.obj\"  # why\r\norbit 30 -10\nundo\n");
    ASSERT_THAT(lines, SizeIs(3));
    EXPECT_EQ(lines[0].number, 3);
    EXPECT_EQ(lines[0].command, "open");
    EXPECT_THAT(lines[0].arguments, ElementsAre("a b.obj"));
    EXPECT_EQ(number_at(lines[1], 1), -10.0);
    EXPECT_EQ(lines[2].number, 5);
}

TEST(Script, RefusesWhatItDoesNotKnow) {
    const auto parse = [](const char* text) { return [text] { parse_script(text); }; };
    EXPECT_THAT(parse("undo\njump 3\n"),
                ThrowsMessage<Error>(HasSubstr("line 2: unknown command 'jump'; known: open")));
    EXPECT_THAT(parse("orbit 30"), ThrowsMessage<Error>(HasSubstr("line 1: should be: orbit AZ EL")));
    EXPECT_THAT(parse("open \"a"), ThrowsMessage<Error>(HasSubstr("quote")));
    const auto lines = parse_script("zoom much");
    EXPECT_THAT([&] { number_at(lines.front(), 0); }, ThrowsMessage<Error>(HasSubstr("much")));
}

}  // namespace
}  // namespace pellucid::viewer
