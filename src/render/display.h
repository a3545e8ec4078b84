#pragma once

#include "render/tiles.h"
#include "shade/adaptation.h"

#include <pellucid/renderer.h>

#include <span>

namespace pellucid {

/// Radiance that has been drawn: on the host, and on the device if the picture is one tile.
struct DrawnPicture {
    Image& radiance;                      ///< RGB
    const GpuImage* on_device = nullptr;  ///< RGBA32F
    float scale = 1.0f;                   ///< makes it the mean over the samples
};

/// Display values, RGB 0..1, tile by tile. What the eye adapts to is the whole picture.
Image display_picture(Recorder& recorder, const Frame& frame, std::span<const Tile> tiles, const DrawnPicture& picture,
                      Adaptation& adaptation, const RenderSettings& settings);

/// RGB of an RGBA32F image.
Image download_rgb(const Device& device, const GpuImage& image);

}  // namespace pellucid
