#include <pellucid/names.h>

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace pellucid {
namespace {

/// Letters to insert, delete, replace, or swap with their neighbour, to get from one name to the other: the optimal string
/// alignment distance.
std::size_t spelling_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t(0));
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        std::swap(before, last);
        std::swap(last, row);
    }
    return last[b.size()];
}

}  // namespace

std::string did_you_mean(std::string_view name, std::span<const std::string_view> known) {
    constexpr std::size_t kLongest = 64;  // longer names are no slips of the hand
    if (name.size() < 2 || name.size() > kLongest) return {};
    std::string_view nearest;
    // A third of the letters may be wrong.
    std::size_t least = std::max<std::size_t>(1, name.size() / 3) + 1;
    for (const std::string_view candidate : known) {
        const std::size_t distance = spelling_distance(name, candidate);
        if (distance < least) nearest = candidate, least = distance;
    }
    // Or all of them are right, and the end is missing.
    for (const std::string_view candidate : known)
        if (nearest.empty() && candidate.starts_with(name)) nearest = candidate;
    return nearest.empty() ? "" : fmt::format(" (did you mean {}?)", nearest);
}

Error unknown_name(std::string_view what, std::string_view name, std::span<const std::string_view> known) {
    return Error(fmt::format("unknown {} '{}'{}; known: {}", what, one_line(name), did_you_mean(name, known),
                             fmt::join(known, ", ")));
}

}  // namespace pellucid
