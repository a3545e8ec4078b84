#include "lab/image_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid::cli {
namespace {

/// Of an image of N samples, from its difference to one of N/2 others: variances add up to 3 times that of N samples.
double noise_of(const RenderResult& image, const RenderResult& of_half, const std::vector<std::uint8_t>& covered) {
    return mean(flip_ldr(image.display, of_half.display), covered) / std::numbers::sqrt3;
}

/// With twice the samples, none of which has been drawn before.
void double_samples(Renderer& renderer, RenderSettings settings, const std::vector<std::uint8_t>& covered,
                    ImageTruth& truth) {
    settings.first_sample = 2 * truth.samples;  // those before have been drawn
    settings.samples = 2 * truth.samples;
    RenderResult result = renderer.render(settings);
    truth.noise = noise_of(result, truth.result, covered);
    truth.result = std::move(result);
    truth.samples = settings.samples;
}

/// The smallest difference of at least `least` between mean FLIP of two of `images`; 1 where there is none.
double smallest_difference(const std::vector<const Image*>& images, const ImageTruth& truth,
                           const std::vector<std::uint8_t>& covered, double least) {
    std::vector<double> flips;
    for (const Image* image : images) flips.push_back(mean(flip_ldr(truth.result.display, *image), covered));
    std::ranges::sort(flips);
    double smallest = 1.0;
    for (std::size_t i = 1; i < flips.size(); ++i)
        if (flips[i] - flips[i - 1] >= least) smallest = std::min(smallest, flips[i] - flips[i - 1]);
    return smallest;
}

}  // namespace

ImageTruth draw_truth(Renderer& renderer, const RenderSettings& settings, const std::vector<std::uint8_t>& covered) {
    ImageTruth truth{settings.technique, settings.samples, renderer.render(settings), {}};
    if (!find_technique(settings.technique).all_light || settings.samples < 2 || std::ranges::count(covered, 1) == 0)
        return truth;
    RenderSettings half = settings;
    half.first_sample = settings.samples;
    half.samples = settings.samples / 2;
    truth.noise = noise_of(truth.result, renderer.render(half), covered);
    return truth;
}

void TruthNoise::add_view(Renderer& renderer, const RenderSettings& settings, const std::vector<std::uint8_t>& covered,
                          const std::vector<const Image*>& images, std::uint32_t most, ImageTruth& truth) {
    constexpr double kShare = 1.0 / 3.0;
    constexpr double kShown = 1e-4;       // the last digit of the table
    constexpr double kWorthwhile = 1e-3;  // smaller differences ask for no more samples
    if (!truth.noise) return;
    while (2 * truth.samples <= most &&
           *truth.noise > kShare * smallest_difference(images, truth, covered, kWorthwhile))
        double_samples(renderer, settings, covered, truth);
    ++views_;
    samples = std::max(samples, truth.samples);
    if (*truth.noise <= kShare * smallest_difference(images, truth, covered, kShown)) return;
    ++above_;
    largest_ = std::max(largest_, *truth.noise);
}

std::optional<std::string> TruthNoise::warning() const {
    if (above_ == 0) return std::nullopt;
    return fmt::format(
        "the noise of the truth is up to {:.4f} in FLIP: differences between techniques of less than {:.4f} say "
        "nothing "
        "({} of {} views); more --truth-samples lower it",
        largest_, 3.0 * largest_, above_, views_);
}

}  // namespace pellucid::cli
