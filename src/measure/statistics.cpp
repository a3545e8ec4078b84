#include <pellucid/measure.h>

#include <pellucid/error.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pellucid {
namespace {

/// Nearest rank: the smallest value that at least `percent` per cent of the values do not exceed.
double percentile(std::vector<double>& values, std::size_t percent) {
    const std::size_t rank = (values.size() * percent + 99) / 100;
    const auto place = values.begin() + std::ptrdiff_t(rank - 1);
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

}  // namespace

Spread spread(std::vector<double> values) {
    if (values.empty()) throw Error("no values, so no median");
    for (double& value : values)
        if (std::isnan(value)) value = std::numeric_limits<double>::infinity();
    return {percentile(values, 50), percentile(values, 95)};
}

}  // namespace pellucid
