// Files of tests/fuzz/corpus, those that tools/fuzz has found included: each loads or is refused.
#include "fuzz/fuzz_target.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace pellucid {
namespace {

using namespace test;

void replay(const FuzzTarget& target) {
    const std::filesystem::path folder = std::filesystem::path(PELLUCID_FUZZ_CORPUS) / target.name;
    // Some files ask for gigabytes: they are refused sooner.
    setenv("PELLUCID_MEMORY_SHARE", "0.02", 1);
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        ++files;
        SCOPED_TRACE(entry.path().string());
        EXPECT_NO_THROW(run_fuzz_target(target, content_of(entry.path())));
    }
    unsetenv("PELLUCID_MEMORY_SHARE");
    EXPECT_GT(files, 0u);
}

class FuzzCorpus : public testing::TestWithParam<FuzzTarget> {};

TEST_P(FuzzCorpus, EachFileLoadsOrIsRefused) { replay(GetParam()); }

const auto kName = [](const testing::TestParamInfo<FuzzTarget>& info) { return std::string(info.param.name); };
INSTANTIATE_TEST_SUITE_P(Readers, FuzzCorpus, testing::ValuesIn(reader_targets().begin(), reader_targets().end()),
                         kName);
INSTANTIATE_TEST_SUITE_P(Commands, FuzzCorpus, testing::ValuesIn(command_targets().begin(), command_targets().end()),
                         kName);

}  // namespace
}  // namespace pellucid
