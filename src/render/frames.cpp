// Frames that run while the caller goes on.
#include "gpu/failures.h"
#include "render/approximations.h"
#include "render/check_settings.h"
#include "render/frame_queue.h"
#include "render/renderer_impl.h"

#include <pellucid/error.h>
#include <pellucid/vulkan.h>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <deque>

namespace pellucid::vulkan {
namespace {

constexpr std::uint32_t kMostInFlight = 8;
/// Frames for which images of another size are kept: callers that change their resolution often come back to it.
constexpr std::uint32_t kKeptFrames = 64;

/// Thrown in what the host traces for a frame that nobody wants any more.
struct TracingStopped {};

/// Whether frames of `a` and `b` are samples of one picture.
bool same_picture(const RenderSettings& a, const RenderSettings& b) {
    return a.width == b.width && a.height == b.height && a.technique == b.technique && a.parameters == b.parameters &&
           a.layer_builder == b.layer_builder && a.view == b.view && a.samples == b.samples &&
           a.first_sample == b.first_sample && a.still == b.still && a.light == b.light && a.thickness == b.thickness;
}

/// Throws Error if frames do not have what the settings ask for.
void check_frame_settings(const RenderSettings& settings) {
    const auto refuse = [](bool asked, const char* what) {
        if (asked) throw Error(fmt::format("frames have no {}; render() does", what));
    };
    refuse(!settings.aovs.empty(), "AOVs");
    refuse(settings.paths, "paths");
    refuse(settings.photon_flux, "photon flux");
    refuse(settings.error > 0.0f, "samples of their own for each pixel (error)");
    refuse(settings.tile_pixels > 0, "tiles");
    refuse(settings.tonemap == ToneMap::kKrawczyk, "tone map krawczyk");
    refuse(settings.view == View::kWavefront, "view wavefront");
}

enum class Channels { kRadiance, kRgba, kBgra };

Channels channels_of(VkFormat format) {
    switch (format) {
        case VK_FORMAT_R8G8B8A8_UNORM:
        case VK_FORMAT_R8G8B8A8_SRGB:
            return Channels::kRgba;
        case VK_FORMAT_B8G8R8A8_UNORM:
        case VK_FORMAT_B8G8R8A8_SRGB:
            return Channels::kBgra;
        case VK_FORMAT_R32G32B32A32_SFLOAT:
            return Channels::kRadiance;
        default:
            throw Error(fmt::format("a frame's target has a format that is not drawn to: {}",
                                    vk::to_string(vk::Format(format))));
    }
}

void check_background(const Background* background, const RenderSettings& settings) {
    if (background == nullptr) return;
    if (background->color == VK_NULL_HANDLE || background->depth == VK_NULL_HANDLE)
        throw Error("a frame's background needs two images, colour and depth");
    if (background->zz == 0.0f && background->zw == 0.0f)
        throw Error("a frame's background needs the projection of its depths");
    if (settings.samples > 1) throw Error("frames before a background have one sample each");
}

void check_target(const Target& target) {
    channels_of(target.format);
    if (target.image == VK_NULL_HANDLE) throw Error("a frame's target has no image");
    if (target.layout_after == VK_IMAGE_LAYOUT_UNDEFINED || target.layout_after == VK_IMAGE_LAYOUT_PREINITIALIZED)
        throw Error("a frame's target needs a layout that it can be left in");
    if (target.offset.x < 0 || target.offset.y < 0) throw Error("a frame's first texel lies outside of its target");
}

void check_frame(const RenderSettings& settings, const Target& target, const Background* background,
                 const Device& device) {
    check_settings(settings, device);
    check_frame_settings(settings);
    check_target(target);
    check_background(background, settings);
}

}  // namespace

struct Frames::Impl {
    Impl(Renderer& renderer, std::uint32_t in_flight) : of(*renderer.impl_), queue(of.device), slots(in_flight) {
        for (auto& slot : slots) slot = std::make_unique<Slot>(of.device);
    }

    struct Slot {
        explicit Slot(const Device& device) : recorder(device), done(device.handle().createEvent({})), run(device) {}
        Recorder recorder;
        vk::raii::Event done;  ///< set by the last command of a frame that was recorded
        FrameRun run;
        Ticket ticket = 0;  ///< 0: free
        bool submitted = false;
        std::optional<Frame> frame;
        std::uint64_t picture = 0;
        std::uint32_t samples = 0;
        bool draws = false;
        bool traces = false;               ///< the host traces a truth in it
        std::atomic<bool> stopped{false};  ///< before it had
        LightTransport light = LightTransport::kEnvironment;
        std::vector<std::string> warnings;
        EventCounts counts{};
    };

    Renderer::Impl& of;
    FrameQueue queue;
    std::vector<std::unique_ptr<Slot>> slots;
    std::deque<Slot*> unread;  ///< in the order of their tickets
    Ticket last = 0;
    // The picture that is being drawn.
    RenderSettings settings;
    std::uint64_t changes = 0;  ///< Renderer::Impl::changes that it is of
    std::uint64_t seen = 0;     ///< likewise, of the last frame
    std::uint64_t picture = 0;  ///< its number
    std::uint32_t drawn = 0;    ///< its samples so far
    /// What the frames of some settings need, and what was found when it was prepared.
    struct Prepared {
        RenderSettings settings;
        std::uint64_t changes;  ///< of all but the camera
        bool recorded;
        FrameSettings chosen;
        LightTransport light;
        std::vector<std::string> warnings;
    };
    std::optional<Prepared> prepared;
    const GpuImage* shown = nullptr;  ///< radiance of the last frame: the sum of the samples

    Slot& free_slot();
    void import(Slot& slot, const Background* background);
    void draw(Slot& slot, const RenderSettings& wanted, const Target& target, const Background* background,
              bool recorded);
    void prepare(bool recorded);
    const GpuImage& draw_sample(Slot& slot, bool recorded);
    TracedView traced_view(Slot& slot, std::optional<std::uint32_t> sample);
    void stop_tracing();
    void forget(Slot& slot);
    Ticket begin(Slot& slot);
    FrameReport finish(Slot& slot);
};

Frames::Impl::Slot& Frames::Impl::free_slot() {
    const auto free = std::find_if(slots.begin(), slots.end(), [](const auto& slot) { return slot->ticket == 0; });
    if (free == slots.end()) throw Error(fmt::format("{} frames are in flight already: read one", slots.size()));
    return **free;
}

/// Lets the technique compute what it wants of the scene. Where nothing but the camera has changed since the last frame, that
/// is hardly anything.
void Frames::Impl::prepare(bool recorded) {
    const Camera camera = of.camera_for(settings);
    const std::uint64_t scene_changes = of.changes - of.camera_changes;
    const bool same = prepared && scene_changes == prepared->changes && recorded == prepared->recorded &&
                      same_picture(settings, prepared->settings);
    if (same) {
        if (of.scene->topology) of.scene->topology->look_from(of.device, of.cpu.scene(), camera);
        return;
    }
    prepared.reset();
    std::vector<std::string> warnings;
    const FrameSettings chosen = of.frame_settings(settings, warnings, recorded);
    const LightOptions light = of.chosen_light(settings);
    of.prepare(chosen, of.frame_light(light), camera, {}, warnings, recorded);
    of.light_solids(settings.thickness, of.all_lights(), {}, warnings);
    prepared.emplace(Prepared{settings, scene_changes, recorded, chosen, light.transport, std::move(warnings)});
}

/// Draws the next sample of the picture. Returns the radiance of all so far, a sum.
const GpuImage& Frames::Impl::draw_sample(Slot& slot, bool recorded) {
    Recorder& recorder = slot.recorder;
    prepare(recorded);
    const FrameSettings& chosen = prepared->chosen;
    slot.light = prepared->light;
    slot.warnings = prepared->warnings;
    Frame& frame = slot.frame.emplace(of.lit_frame(recorder, settings));
    frame.recorded = recorded;
    std::optional<std::uint32_t> sample;
    if (settings.samples > 1) {
        sample = drawn;
        frame.sample = drawn;
        if (settings.still) frame.samples = settings.samples;
    }
    Renderer::Impl::begin_frame(recorder, frame, of.constants_of(frame, settings, sample));
    of.photons.count_flux(false);
    if (of.photons.any()) of.photons.record(recorder, frame);
    if (of.irradiance.any()) {
        of.irradiance.gather(recorder, frame, drawn == 0);
        of.irradiance.store(recorder);
    }
    slot.traces = chosen.truth != nullptr;
    std::optional<TracedView> traced;
    if (slot.traces) traced.emplace(traced_view(slot, sample));
    slot.counts = {};
    const GpuImage* radiance = nullptr;
    if (draws_picture(chosen)) {
        const FrameImages images = record_frame(recorder, frame, chosen, of.layer_source,
                                                of.solid_lighting.transmitted(), traced ? &*traced : nullptr);
        count_events(recorder, frame, images.refraction, [&slot](const EventCounts& counts) { slot.counts = counts; });
        radiance = &images.radiance;
    } else {
        radiance = &trace_sample(recorder, frame, *chosen.truth, *traced, of.environment,
                                 settings.first_sample + sample.value_or(0), chosen.parameters);
    }
    if (chosen.technique && chosen.technique->report) chosen.technique->report(*of.scene, slot.warnings);
    return settings.samples > 1 ? accumulate(recorder, frame, *radiance, drawn) : *radiance;
}

TracedView Frames::Impl::traced_view(Slot& slot, std::optional<std::uint32_t> sample) {
    slot.stopped = false;
    const Progress progress = [&slot](double) {
        if (slot.stopped) throw TracingStopped();
    };
    return of.traced_view(settings, sample, progress);
}

/// What the host is tracing is about to change.
void Frames::Impl::stop_tracing() {
    for (Slot* slot : unread) {
        if (!slot->submitted || !slot->traces) continue;
        slot->stopped = true;
        queue.wait(slot->run);
    }
}

/// Takes over what the caller has drawn.
void Frames::Impl::import(Slot& slot, const Background* background) {
    of.background_radiance = of.background_depth = nullptr;
    if (background == nullptr) return;
    Recorder& recorder = slot.recorder;
    Frame frame = of.frame_of(recorder, settings);
    Renderer::Impl::begin_frame(recorder, frame, of.constants_of(frame, settings, std::nullopt));
    const GpuImage& radiance = of.workspace.image("background radiance", vk::Format::eR32G32B32A32Sfloat, frame.extent);
    const std::uint64_t texels = std::uint64_t(frame.extent.width) * frame.extent.height;
    const Buffer& depths = of.workspace.buffer("the caller's depths", texels * sizeof(float));
    recorder.copy_from(background->color, vk::ImageLayout(background->color_layout), radiance);
    recorder.copy_depths_from(background->depth, vk::ImageLayout(background->depth_layout), frame.extent, depths);
    of.background_depth =
        &import_depth(recorder, frame, depths,
                      {{background->zz, background->zw, background->wz, background->ww}, background->far_depth});
    of.background_radiance = &radiance;
}

void Frames::Impl::draw(Slot& slot, const RenderSettings& wanted, const Target& target, const Background* background,
                        bool recorded) {
    if (changes != of.changes || !same_picture(wanted, settings) || wanted.samples == 1) {
        ++picture;
        drawn = 0;
        changes = of.changes;
    }
    settings = wanted;
    settings.progress = {};
    slot.picture = picture;
    slot.warnings.clear();
    slot.draws = shown == nullptr || drawn < settings.samples;
    if (seen != of.changes) {
        // What the host looks at, and the device reads from the host, is about to change.
        for (Slot* running : unread)
            if (running->submitted && running->run.parts.size() > 1) queue.wait(running->run);
        seen = of.changes;
    }
    if (slot.draws) {
        of.workspace.trim();
        import(slot, background);
        shown = &draw_sample(slot, recorded);
        of.background_radiance = of.background_depth = nullptr;
        ++drawn;
    } else {
        slot.recorder.upload_pending();
        slot.frame.emplace(of.frame_of(slot.recorder, settings));
    }
    slot.samples = drawn;
    const auto scale = float(1.0 / double(drawn));
    const Channels channels = channels_of(target.format);
    const Frame& frame = *slot.frame;
    const GpuImage& image = channels == Channels::kRadiance
                                ? scale_radiance(slot.recorder, frame, *shown, scale)
                                : tonemap(slot.recorder, frame, *shown, scale * std::exp2(settings.exposure_ev),
                                          settings.tonemap, channels == Channels::kBgra);
    slot.recorder.copy_to(image, target.image, {target.offset.x, target.offset.y}, vk::ImageLayout(target.layout),
                          vk::ImageLayout(target.layout_after));
}

/// What was recorded does not run.
void Frames::Impl::forget(Slot& slot) {
    slot.recorder.restart();
    slot.frame.reset();
    of.background_radiance = of.background_depth = nullptr;
    prepared.reset();
    shown = nullptr;
    drawn = 0;
    ++picture;
    of.filtered_is_current = false;
    of.irradiance.forget();
}

Ticket Frames::Impl::begin(Slot& slot) {
    slot.ticket = ++last;
    unread.push_back(&slot);
    ++of.unread_frames;
    return slot.ticket;
}

FrameReport Frames::Impl::finish(Slot& slot) {
    unread.pop_front();
    --of.unread_frames;
    slot.ticket = 0;
    if (slot.submitted && slot.run.failure) {
        forget(slot);
        try {
            std::rethrow_exception(slot.run.failure);
        } catch (const TracingStopped&) {
            FrameReport stopped;
            stopped.light = slot.light;
            return stopped;
        }
    }
    FrameReport report;
    report.passes = slot.recorder.finish();
    report.light = slot.light;
    report.warnings = std::move(slot.warnings);
    for (std::size_t i = 0; slot.draws && i < report.status.size(); ++i)
        report.covered += report.status[i] = slot.counts.statuses[i];
    report.side_conflicts = slot.draws ? slot.counts.side_conflicts : 0;
    if (slot.draws) {
        const Frame& frame = *slot.frame;
        const auto note = [&](bool outgrown, const std::vector<std::string>& what) {
            if (outgrown) report.overflows.insert(report.overflows.end(), what.begin(), what.end());
        };
        note(of.layer_source.must_repeat(frame), of.layer_source.outgrown());
        note(of.solid_lighting.transmitted().must_repeat(frame), {"maps of light"});
        note(of.photons.must_repeat(frame), {"photons"});
        note(of.irradiance.outgrown(frame), {"surfaces that gather irradiance"});
    }
    // A picture to which a frame has added less than there is begins anew.
    if (!report.overflows.empty() && slot.picture == picture) {
        ++picture;
        drawn = 0;
    }
    const bool whole = slot.picture == picture || (settings.samples == 1 && report.overflows.empty());
    report.samples = whole ? slot.samples : 0;
    return report;
}

Frames::Frames(Renderer& renderer, std::uint32_t in_flight) {
    if (in_flight == 0 || in_flight > kMostInFlight)
        throw Error(fmt::format("{} frames in flight; there may be 1 to {}", in_flight, kMostInFlight));
    if (renderer.impl_->has_frames) throw Error("the renderer has frames already (vulkan::Frames)");
    impl_ = std::make_unique<Impl>(renderer, in_flight);
    renderer.impl_->has_frames = true;
    renderer.impl_->workspace.keep(kKeptFrames);
    renderer.impl_->before_change = [impl = impl_.get()] { impl->stop_tracing(); };
}

Frames::~Frames() {
    for (Impl::Slot* slot : impl_->unread) {
        slot->stopped = true;
        try {
            if (slot->submitted) impl_->queue.wait(slot->run);
            slot->recorder.restart();
        } catch (const vk::SystemError&) {  // the device is lost: nothing runs on it any more
        }
        --impl_->of.unread_frames;
    }
    impl_->of.has_frames = false;
    impl_->of.workspace.keep(0);
    impl_->of.before_change = nullptr;
}

std::string Frames::unrecordable(const RenderSettings& settings) const {
    const TechniqueInfo& info = *impl_->of.choose(settings.technique, true).technique;
    if (!info.recordable) return fmt::format("{} has parts on the host; submit() takes them", info.name);
    return {};
}

Ticket Frames::record(VkCommandBuffer commands, const RenderSettings& settings, const Target& target,
                      const Background* background) try {
    check_frame(settings, target, background, impl_->of.device);
    if (const std::string why = unrecordable(settings); !why.empty()) throw Error("cannot be recorded: " + why);
    Impl::Slot& slot = impl_->free_slot();
    slot.submitted = false;
    slot.recorder.restart(commands);
    slot.done.reset();
    try {
        impl_->draw(slot, settings, target, background, true);
    } catch (...) {
        impl_->forget(slot);
        throw;
    }
    slot.recorder.end(*slot.done);
    return impl_->begin(slot);
} catch (const vk::SystemError& failure) {
    throw_clearly(failure);
}

Ticket Frames::submit(const RenderSettings& settings, const Target& target, std::span<const SemaphoreValue> wait,
                      std::span<const SemaphoreValue> signal, const Background* background) try {
    check_frame(settings, target, background, impl_->of.device);
    Impl::Slot& slot = impl_->free_slot();
    slot.submitted = true;
    slot.recorder.restart();
    try {
        impl_->draw(slot, settings, target, background, false);
        slot.run.parts = slot.recorder.end();
        slot.run.wait.assign(wait.begin(), wait.end());
        slot.run.signal.assign(signal.begin(), signal.end());
        impl_->queue.submit(slot.run);
    } catch (...) {
        impl_->forget(slot);
        throw;
    }
    return impl_->begin(slot);
} catch (const vk::SystemError& failure) {
    throw_clearly(failure);
}

std::optional<FrameReport> Frames::read(Ticket ticket) try {
    if (impl_->unread.empty() || impl_->unread.front()->ticket != ticket)
        throw Error(fmt::format("ticket {} is not the oldest that has not been read", ticket));
    Impl::Slot& slot = *impl_->unread.front();
    const bool has_run =
        slot.submitted ? impl_->queue.has_run(slot.run) : slot.done.getStatus() == vk::Result::eEventSet;
    if (!has_run) return std::nullopt;
    return impl_->finish(slot);
} catch (const vk::SystemError& failure) {
    throw_clearly(failure);
}

FrameReport Frames::wait(Ticket ticket) try {
    if (!impl_->unread.empty() && impl_->unread.front()->submitted) impl_->queue.wait(impl_->unread.front()->run);
    std::optional<FrameReport> report = read(ticket);
    if (!report) throw Error(fmt::format("ticket {} was recorded: whoever submits it waits for it", ticket));
    return std::move(*report);
} catch (const vk::SystemError& failure) {
    throw_clearly(failure);
}

std::uint32_t Frames::unread() const { return std::uint32_t(impl_->unread.size()); }

void Frames::restart() { impl_->changes = ~std::uint64_t(0); }

Made Frames::made() const { return impl_->of.device.made(); }

}  // namespace pellucid::vulkan
