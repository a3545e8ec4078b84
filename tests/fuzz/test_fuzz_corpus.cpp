// Files of tests/fuzz/corpus, those that tools/fuzz has found included, and of tests/fuzz/libraries, which make libraries
// crash or run out of memory: each loads or is refused.
#include "fuzz/fuzz_target.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace pellucid {
namespace {

using namespace test;

std::size_t replay(const FuzzTarget& target, const char* folder) {
    const std::filesystem::path files = std::filesystem::path(PELLUCID_FUZZ_FOLDER) / folder / target.name;
    if (!std::filesystem::exists(files)) return 0;
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(files)) {
        ++count;
        SCOPED_TRACE(entry.path().string());
        EXPECT_NO_THROW(run_fuzz_target(target, content_of(entry.path())));
    }
    return count;
}

class FuzzCorpus : public testing::TestWithParam<FuzzTarget> {};

TEST_P(FuzzCorpus, EachFileLoadsOrIsRefused) {
    EXPECT_GT(replay(GetParam(), "corpus"), 0u);
    replay(GetParam(), "libraries");
}

const auto kName = [](const testing::TestParamInfo<FuzzTarget>& info) { return std::string(info.param.name); };
INSTANTIATE_TEST_SUITE_P(Readers, FuzzCorpus, testing::ValuesIn(reader_targets().begin(), reader_targets().end()),
                         kName);
INSTANTIATE_TEST_SUITE_P(Commands, FuzzCorpus, testing::ValuesIn(command_targets().begin(), command_targets().end()),
                         kName);

}  // namespace
}  // namespace pellucid
