#pragma once

#include "render/tiles.h"
#include "shade/adaptation.h"

#include <pellucid/renderer.h>

#include <span>

namespace pellucid {

/// Radiance of a drawn image: on the host, and for an image of one tile also on the device.
struct DrawnPicture {
    Image& radiance;                      ///< RGB
    const GpuImage* on_device = nullptr;  ///< RGBA32F
    float scale = 1.0f;                   ///< factor that converts it into the mean over the samples
};

/// Display values, RGB 0..1, computed tile by tile. The eye adapts to the whole image.
Image display_picture(Recorder& recorder, const Frame& frame, std::span<const Tile> tiles, const DrawnPicture& picture,
                      Adaptation& adaptation, const RenderSettings& settings);

/// Downloads the RGB of an RGBA32F image.
Image download_rgb(const Device& device, const GpuImage& image);

}  // namespace pellucid
