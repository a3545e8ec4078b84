// Names that are nearly right, and the names of values of parameters.
#include <pellucid/names.h>
#include <pellucid/technique.h>

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>
#include <string>

namespace pellucid {
namespace {

constexpr std::array<std::string_view, 4> kKnown = {"render", "compare", "bench", "info"};

TEST(Names, TheNearestIsSuggested) {
    EXPECT_EQ(did_you_mean("rendr", kKnown), " (did you mean render?)");
    EXPECT_EQ(did_you_mean("rednre", kKnown), " (did you mean render?)");  // two pairs swapped
    EXPECT_EQ(did_you_mean("compares", kKnown), " (did you mean compare?)");
    EXPECT_EQ(did_you_mean("com", kKnown), " (did you mean compare?)");  // the end is missing
    EXPECT_EQ(did_you_mean("ino", kKnown), " (did you mean info?)");
}

TEST(Names, NothingIsSuggestedWhereNothingIsNear) {
    for (const char* name : {"", "x", "paint", "renovate", "benchmarks-of-all"})
        EXPECT_EQ(did_you_mean(name, kKnown), "") << name;
    EXPECT_EQ(did_you_mean(std::string(100000, 'r'), kKnown), "");
}

TEST(Names, AnErrorListsWhatIsKnownInOneLine) {
    EXPECT_STREQ(unknown_name("command", "ren\nder", kKnown).what(),
                 "unknown command 'ren der' (did you mean render?); known: render, compare, bench, info");
    EXPECT_STREQ(unknown_name("command", "paint", kKnown).what(),
                 "unknown command 'paint'; known: render, compare, bench, info");
}

/// The command line has one option for all parameters of a name, so a name has one value.
TEST(Names, ValuesOfParametersAgree) {
    std::map<std::pair<std::string_view, std::string_view>, double> values;
    for (const TechniqueInfo* technique : techniques()) {
        for (const ParameterInfo& parameter : technique->parameters) {
            std::set<double> own;
            for (const NamedValue& named : parameter.names) {
                EXPECT_TRUE(named.value >= parameter.minimum && named.value <= parameter.maximum)
                    << technique->name << " " << parameter.name << " " << named.name;
                EXPECT_TRUE(own.insert(named.value).second) << technique->name << " " << named.name;
                const auto [found, is_new] = values.try_emplace({parameter.name, named.name}, named.value);
                EXPECT_EQ(found->second, named.value) << technique->name << " " << parameter.name;
            }
            // A whole number of few values is a choice.
            if (parameter.whole && parameter.maximum - parameter.minimum <= 3.0) {
                EXPECT_EQ(double(own.size()), parameter.maximum - parameter.minimum + 1.0)
                    << technique->name << " " << parameter.name;
            }
        }
    }
    EXPECT_FALSE(values.empty());
}

}  // namespace
}  // namespace pellucid
