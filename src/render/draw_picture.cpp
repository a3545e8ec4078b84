// Drawing of an image: tiles, samples of each tile, and frames, which are repeated until their buffers fit.
#include "render/renderer_impl.h"

#include "render/adaptive_sampling.h"

#include <algorithm>
#include <utility>

namespace pellucid {
namespace {

/// Adds passes of earlier attempts at the frame that this attempt did not repeat, such as building a hierarchy.
std::vector<PassTime> with_missing_passes(std::vector<PassTime> times, const std::vector<PassTime>& earlier) {
    for (const PassTime& pass : earlier) {
        const bool repeated =
            std::any_of(times.begin(), times.end(), [&](const PassTime& time) { return time.name == pass.name; });
        if (!repeated) times.push_back(pass);
    }
    return times;
}

constexpr double kPilotShare = 0.1;  ///< share of pilot samples in the reported progress

Image image_of(const std::vector<std::uint32_t>& counts, vk::Extent2D extent) {
    Image image(int(extent.width), int(extent.height), 1);
    std::transform(counts.begin(), counts.end(), image.pixels.begin(),
                   [](std::uint32_t count) { return float(count); });
    return image;
}

const GpuImage& upload_counts(const Frame& frame, const std::vector<std::uint32_t>& counts) {
    const GpuImage& image = frame.workspace.image("wanted samples", vk::Format::eR32Uint, frame.extent);
    upload(frame.workspace.device(), image, 0, std::as_bytes(std::span(counts)));
    return image;
}

}  // namespace

void Renderer::Impl::light_frame(const Frame& frame, bool first, std::vector<PassTime>& times) {
    if (!photons.any() && !irradiance.any()) return;
    for (bool again = true; again;) {
        if (photons.any()) photons.record(recorder, frame);
        if (irradiance.any()) irradiance.gather(recorder, frame, first);
        times = with_missing_passes(recorder.submit_and_wait(), times);
        again = photons.must_repeat(frame);
        again = irradiance.must_repeat() || again;
    }
    if (!irradiance.any()) return;
    irradiance.store(recorder);
    times = with_missing_passes(std::move(times), recorder.submit_and_wait());
}

FrameImages Renderer::Impl::draw_until_fits(const Frame& frame, const FrameSettings& chosen, const TracedView* traced,
                                            std::vector<PassTime>& times) {
    TransmittedLight& transmitted = solid_lighting.transmitted();
    for (;;) {
        const FrameImages images = record_frame(recorder, frame, chosen, layer_source, transmitted, traced);
        times = with_missing_passes(recorder.submit_and_wait(), times);
        const bool transmitted_again = transmitted.must_repeat(frame);
        if (!layer_source.must_repeat(frame) && !transmitted_again) return images;
    }
}

std::vector<PassTime> Renderer::Impl::run_frame(Frame& frame, const FrameSettings& chosen,
                                                const RenderSettings& settings, std::optional<std::uint32_t> sample,
                                                const Progress& progress, std::optional<FrameImages>& images) {
    begin_frame(recorder, frame, constants_of(frame, settings, sample));
    photons.count_flux(settings.photon_flux && !sample);
    std::optional<TracedView> traced;
    if (chosen.truth) traced.emplace(traced_view(settings, sample, progress));
    std::vector<PassTime> times;
    light_frame(frame, sample.value_or(0) == 0, times);
    images.emplace(draw_until_fits(frame, chosen, traced ? &*traced : nullptr, times));
    return times;
}

std::map<std::string, const GpuImage*> Renderer::Impl::draw_parts(Frame& frame, const FrameSettings& chosen,
                                                                  const RenderSettings& settings,
                                                                  std::optional<std::uint32_t> sample,
                                                                  const GpuImage* wanted) {
    std::map<std::string, const GpuImage*> sums;
    std::optional<TracedView> traced;
    if (chosen.truth) traced.emplace(traced_view(settings, sample, Progress()));
    for (std::uint32_t part = 0; part < kLightParts.size(); ++part) {
        const std::string name(kLightParts[part]);
        if (std::find(settings.aovs.begin(), settings.aovs.end(), name) == settings.aovs.end()) continue;
        begin_frame(recorder, frame, constants_of(frame, settings, sample, part + 1));
        std::vector<PassTime> times;
        const FrameImages images = draw_until_fits(frame, chosen, traced ? &*traced : nullptr, times);
        sums[name] = &accumulate(recorder, frame, images.radiance, sample.value_or(0), wanted, name);
        recorder.submit_and_wait();
    }
    return sums;
}

const GpuImage& Renderer::Impl::draw_sample(Frame& frame, const FrameSettings& chosen, const RenderSettings& settings,
                                            std::uint32_t sample, const Progress& progress, RenderResult& part) {
    std::optional<FrameImages> images;
    part.frames.push_back(run_frame(frame, chosen, settings, sample, progress, images));
    part.layer_passes = layer_source.geometry_passes();
    return images->radiance;
}

std::vector<std::uint32_t> Renderer::Impl::samples_for(Frame& frame, const FrameSettings& chosen,
                                                       const RenderSettings& settings, const Progress& progress,
                                                       RenderResult& part) {
    PixelNoise noise;
    for (std::uint32_t i = 0; i < kPilotSamples; ++i) {
        const Progress of_sample = part_of(progress, double(i) / kPilotSamples, double(i + 1) / kPilotSamples);
        // Use sample indices that the image does not use.
        noise.add(
            download_rgb(device, draw_sample(frame, chosen, settings, settings.most_samples + i, of_sample, part)));
    }
    return noise.samples_for(settings.error, settings.exposure_ev, settings.most_samples);
}

const GpuImage* Renderer::Impl::render_samples(Frame& frame, const FrameSettings& chosen,
                                               const RenderSettings& settings, RenderResult& part) {
    const bool draws = draws_picture(chosen);
    // The frame through pixel centres gives the AOVs and counts. With one sample it also is the image.
    std::optional<FrameImages> images;
    const bool adaptive = settings.error > 0.0f;
    const bool alone = draws && settings.samples == 1 && !adaptive;
    std::vector<PassTime> times =
        run_frame(frame, chosen, settings, std::nullopt, alone ? settings.progress : Progress(), images);
    read_back(device, *images, frame.view, scene->first_triangles, settings, part);
    part.layer_passes = layer_source.geometry_passes();
    part.cut_rays = solid_lighting.transmitted().cut_rays();
    if (!draws) return nullptr;
    const GpuImage* sum = &images->radiance;
    if (alone) {
        part.frames.push_back(std::move(times));
        part.radiance = download_rgb(device, *sum);
        if (std::any_of(settings.aovs.begin(), settings.aovs.end(), is_light_part)) {
            sum = &accumulate(recorder, frame, *sum, 0);  // frames of light parts overwrite the image
            recorder.submit_and_wait();
        }
        for (const auto& [name, image] : draw_parts(frame, chosen, settings, std::nullopt, nullptr))
            part.aovs[name] = download_rgb(device, *image);
        return sum;
    }
    Frame sampled = frame;
    if (settings.still) sampled.samples = adaptive ? settings.most_samples : settings.samples;
    std::uint32_t samples = settings.samples;
    const GpuImage* wanted = nullptr;
    const double before = adaptive ? kPilotShare : 0.0;
    if (adaptive) {
        const auto counts = samples_for(sampled, chosen, settings, part_of(settings.progress, 0.0, before), part);
        samples = *std::max_element(counts.begin(), counts.end());
        part.sample_counts = image_of(counts, frame.extent);
        wanted = &upload_counts(frame, counts);
    }
    std::map<std::string, const GpuImage*> sums;
    for (std::uint32_t sample = 0; sample < samples; ++sample) {
        const auto share = [&](std::uint32_t done) { return before + (1.0 - before) * done / samples; };
        const Progress progress = part_of(settings.progress, share(sample), share(sample + 1));
        if (wanted != nullptr && (chosen.truth || !chosen.technique->searches_layers))
            sampled.wanted_samples.emplace(WantedSamples{*wanted, sample});
        sampled.sample = sample;
        const GpuImage& radiance = draw_sample(sampled, chosen, settings, sample, progress, part);
        // Submit separately: a frame that overflowed was drawn twice, but counts once.
        sum = &accumulate(recorder, frame, radiance, sample, wanted);
        for (PassTime& time : recorder.submit_and_wait()) part.frames.back().push_back(std::move(time));
        sums = draw_parts(sampled, chosen, settings, sample, wanted);
        if (progress) progress(1.0);
    }
    part.radiance = download_rgb(device, *sum);
    for (const auto& [name, image] : sums) part.aovs[name] = download_rgb(device, *image);
    return sum;
}

Renderer::Impl::Drawn Renderer::Impl::draw_tiles(Frame frame, const FrameSettings& chosen,
                                                 const RenderSettings& settings, RenderResult& result) {
    const glm::uvec2 size(settings.width, settings.height);
    // Paths need 16 bytes per pixel in one buffer; other techniques list the pixels with glass.
    std::uint64_t most = most_tile_pixels(device, chosen.info.whole_scene ? 16 : 4);
    if (settings.tile_pixels > 0) most = std::min<std::uint64_t>(most, settings.tile_pixels);
    const std::optional<Tile> glass =
        tile_of_glass(constants_of(frame, settings, std::nullopt), scene->refractive_corners);
    std::vector<Tile> left = tiles_of(size, glass, most, device);
    TileProgress progress(settings.progress, size);
    Drawn drawn;
    while (!left.empty()) {
        const Tile tile = left.back();
        frame.first = tile.first;
        frame.extent = tile.extent();
        RenderSettings of_tile = settings;
        if (progress && draws_picture(chosen)) of_tile.progress = [&](double done) { progress.show(tile, done); };
        RenderResult part;
        try {
            drawn.on_device = render_samples(frame, chosen, of_tile, part);
        } catch (const TooLarge&) {
            if (!halve(left)) throw;
            forget_frame();
            continue;
        }
        left.pop_back();
        add_tile(result, std::move(part), tile, size);
        drawn.tiles.push_back(tile);
        if (draws_picture(chosen) && tile.size != size) progress.show(tile, 1.0);
        progress.finish(tile);
    }
    if (drawn.tiles.size() == 1) return drawn;
    drawn.on_device = nullptr;
    drawn.cut = !glass || !scene->opaque.empty() ||
                std::none_of(drawn.tiles.begin(), drawn.tiles.end(), [&](const Tile& t) { return t.holds(*glass); });
    return drawn;
}

TracedView Renderer::Impl::traced_view(const RenderSettings& settings, std::optional<std::uint32_t> sample,
                                       const Progress& progress) {
    const glm::vec2 jitter_px = jitter_of(settings, sample);
    return {cpu.tracer(), camera_for(settings), {settings.width, settings.height}, jitter_px, progress};
}

void Renderer::Impl::trace_image(const FrameSettings& chosen, const RenderSettings& settings, RenderResult& result) {
    const auto trace = [&](const PictureSamples& samples, const Progress& progress) {
        return chosen.truth->trace_image(traced_view(settings, std::nullopt, progress), environment, samples,
                                         chosen.parameters);
    };
    PictureSamples samples{.count = settings.samples, .first = settings.first_sample};
    const double before = settings.error > 0.0f ? kPilotShare : 0.0;
    if (settings.error > 0.0f) {
        const PathTracedImage pilot =
            trace({.count = kPilotSamples, .first = settings.first_sample + settings.most_samples},
                  part_of(settings.progress, 0.0, before));
        samples.of_pixels = PixelNoise(pilot.radiance, pilot.standard_error, kPilotSamples)
                                .samples_for(settings.error, settings.exposure_ev, settings.most_samples);
        result.sample_counts = image_of(samples.of_pixels, {settings.width, settings.height});
    }
    samples.parts = std::any_of(settings.aovs.begin(), settings.aovs.end(), is_light_part);
    PathTracedImage traced = trace(samples, part_of(settings.progress, before, 1.0));
    for (std::size_t part = 0; part < kLightParts.size(); ++part) {
        const std::string name(kLightParts[part]);
        if (std::find(settings.aovs.begin(), settings.aovs.end(), name) != settings.aovs.end())
            result.aovs[name] = std::move(traced.parts[part]);
    }
    result.warnings.insert(result.warnings.end(), traced.warnings.begin(), traced.warnings.end());
    result.radiance = std::move(traced.radiance);
    result.standard_error = std::move(traced.standard_error);
    result.cut_paths = traced.cut_paths;
}

}  // namespace pellucid
