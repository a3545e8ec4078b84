#include <pellucid/measure.h>

#include <pellucid/error.h>

#include <fmt/format.h>

#include <cmath>

namespace pellucid {
namespace {

void check_mask(const Image& image, std::span<const std::uint8_t> mask) {
    const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
    if (!mask.empty() && mask.size() != pixels)
        throw Error(fmt::format("a mask of {} pixels for an image of {}", mask.size(), pixels));
}

}  // namespace

double mean(const Image& image, std::span<const std::uint8_t> mask) {
    if (image.channels != 1) throw Error(fmt::format("the mean of {} channels, not of one", image.channels));
    check_mask(image, mask);
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        if (!mask.empty() && mask[i] == 0) continue;
        sum += double(image.pixels[i]);
        ++count;
    }
    return count > 0 ? sum / double(count) : 0.0;
}

double rmse(const Image& reference, const Image& test, std::span<const std::uint8_t> mask) {
    if (reference.width != test.width || reference.height != test.height || reference.channels != test.channels) {
        throw Error(fmt::format("images of {} x {} pixels of {} channels and {} x {} of {}: nothing to compare",
                                reference.width, reference.height, reference.channels, test.width, test.height,
                                test.channels));
    }
    check_mask(reference, mask);
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        if (!mask.empty() && mask[i / std::size_t(reference.channels)] == 0) continue;
        const double difference = double(reference.pixels[i]) - double(test.pixels[i]);
        sum += difference * difference;
        ++count;
    }
    return count > 0 ? std::sqrt(sum / double(count)) : 0.0;
}

}  // namespace pellucid
