#include "core/fail.h"

namespace pellucid {

std::string one_line(std::string_view text) {
    std::string line;
    line.reserve(text.size());
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (code > 0x20 && code != 0x7f) {
            line += c;
        } else if (!line.empty() && line.back() != ' ') {
            line += ' ';
        }
    }
    while (!line.empty() && line.back() == ' ') line.pop_back();
    return line;
}

void fail(const std::filesystem::path& file, std::string_view cause) {
    throw Error(one_line(file.string() + ": " + std::string(cause)));
}

std::string shortened(std::string_view text) {
    constexpr std::size_t kLongest = 60;
    return one_line(text.substr(0, kLongest)) + (text.size() > kLongest ? "..." : "");
}

}  // namespace pellucid
