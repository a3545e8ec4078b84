// libFuzzer's entry points. PELLUCID_FUZZ_TARGET names the reader.
#include "fuzz/fuzz_target.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace {

std::span<const pellucid::test::FuzzTarget> targets() { return pellucid::test::PELLUCID_FUZZ_TARGETS(); }

const pellucid::test::FuzzTarget* chosen = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    const char* const name = std::getenv("PELLUCID_FUZZ_TARGET");
    for (const pellucid::test::FuzzTarget& target : targets())
        if (name && target.name == name) chosen = &target;
    if (chosen) return 0;
    std::fputs("PELLUCID_FUZZ_TARGET must be one of:", stderr);
    for (const pellucid::test::FuzzTarget& target : targets()) std::fprintf(stderr, " %s", target.name.data());
    std::fputs("\n", stderr);
    std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    pellucid::test::run_fuzz_target(*chosen, {reinterpret_cast<const char*>(bytes), size});
    return 0;
}
