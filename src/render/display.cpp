#include "render/display.h"

#include "shade/shade.h"

#include <array>
#include <cmath>
#include <cstring>
#include <functional>

namespace pellucid {
namespace {

Image download_display(const Device& device, const GpuImage& image) {
    const std::vector<std::byte> data = download(device, image, 0);
    Image display(int(image.extent().width), int(image.extent().height), 3);
    for (std::size_t i = 0; 3 * i < display.pixels.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            display.pixels[3 * i + c] = float(std::to_integer<int>(data[4 * i + c])) / 255.0f;
    }
    return display;
}

}  // namespace

Image download_rgb(const Device& device, const GpuImage& image) {
    const std::vector<std::byte> data = download(device, image, 0);
    Image rgb(int(image.extent().width), int(image.extent().height), 3);
    for (std::size_t i = 0; 3 * i < rgb.pixels.size(); ++i)
        std::memcpy(rgb.pixels.data() + 3 * i, data.data() + i * 4 * sizeof(float), 3 * sizeof(float));
    return rgb;
}

Image display_picture(Recorder& recorder, const Frame& frame, std::span<const Tile> tiles, const DrawnPicture& picture,
                      Adaptation& adaptation, const RenderSettings& settings) {
    const Device& device = recorder.device();
    // Wavefronts already contain the exposure.
    const float exposure = settings.view == View::kWavefront ? 1.0f : std::exp2(settings.exposure_ev);
    const bool adapts = settings.tonemap == ToneMap::kKrawczyk;
    const Adaptation::Look look{.unit_cd_m2 = picture.scale * settings.unit_luminance_cd_m2,
                                .exposure = exposure,
                                .elapsed_s = settings.adaptation_s};
    const auto for_each_tile = [&](const std::function<void(const Tile&, const Frame&, const GpuImage&)>& use) {
        for (const Tile& tile : tiles) {
            Frame part = frame;
            part.extent = tile.extent();
            const GpuImage* radiance = picture.on_device;
            if (radiance == nullptr) {
                radiance = &frame.workspace.image("tile radiance", vk::Format::eR32G32B32A32Sfloat, part.extent);
                upload_rgb(device, *radiance, tiles.size() == 1 ? picture.radiance : part_of(picture.radiance, tile));
            }
            use(tile, part, *radiance);
        }
    };
    if (adapts) {
        std::vector<vk::Extent2D> parts;
        for (const Tile& tile : tiles) parts.push_back(tile.extent());
        adaptation.begin_picture(frame.workspace, parts);
        for_each_tile([&](const Tile&, const Frame& part, const GpuImage& radiance) {
            adaptation.add(recorder, part, radiance, look);
            if (tiles.size() > 1) recorder.submit_and_wait();
        });
        adaptation.adapt(recorder, frame, look);
    }
    Image display;
    if (tiles.size() > 1) display = Image(picture.radiance.width, picture.radiance.height, 3);
    for_each_tile([&](const Tile& tile, const Frame& part, const GpuImage& radiance) {
        const GpuImage& shown = adapts ? adaptation.tonemap(recorder, part, radiance, look)
                                       : tonemap(recorder, part, radiance, picture.scale * exposure, settings.tonemap);
        recorder.submit_and_wait();
        if (tiles.size() == 1)
            display = download_display(device, shown);
        else
            paste(display, download_display(device, shown), tile);
    });
    return display;
}

}  // namespace pellucid
