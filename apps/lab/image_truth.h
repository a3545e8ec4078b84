#pragma once

#include "lab/accuracy.h"

#include <pellucid/pellucid.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pellucid::cli {

/// Samples of a truth with all light where none are given, and the most that differences between techniques ask for.
inline constexpr std::uint32_t kTruthSamples = 16, kMostTruthSamples = 64;

/// The image that others are judged by.
struct ImageTruth {
    std::string technique;
    std::uint32_t samples = 0;
    RenderResult result;
    std::optional<double>
        noise;  ///< mean FLIP over the glass from an image without noise, estimated; none: no noise known
};

/// Draws the truth with settings.samples. Of one with all light a second image, of half as many other samples, tells the
/// noise: FLIP between both is sqrt(3) times as much.
ImageTruth draw_truth(Renderer& renderer, const RenderSettings& settings, const std::vector<std::uint8_t>& covered);

/// Of all views whose truth has noise, whether that is below a third of the smallest difference between techniques.
class TruthNoise {
public:
    /// `images` are those that `truth` of `settings` judges. While the noise is above a third of the smallest difference
    /// between their mean FLIP, draws the truth anew with twice the samples, up to `most`.
    void add_view(Renderer& renderer, const RenderSettings& settings, const std::vector<std::uint8_t>& covered,
                  const std::vector<const Image*>& images, std::uint32_t most, ImageTruth& truth);

    /// For views whose noise stayed above.
    std::optional<std::string> warning() const;

    std::uint32_t samples = 0;  ///< the most that a truth had

private:
    std::size_t views_ = 0, above_ = 0;
    double largest_ = 0.0;  ///< FLIP, of those above
};

}  // namespace pellucid::cli
