#pragma once

#include <span>
#include <string>
#include <string_view>

namespace pellucid::cli {

/// What 'pellucid help NAME' prints.
struct Topic {
    std::string_view name;
    std::string_view summary;  ///< a few words
    std::string (*text)();     ///< paragraphs and lists; long lines of paragraphs are wrapped where they are printed
};

std::span<const Topic> topics();

}  // namespace pellucid::cli
