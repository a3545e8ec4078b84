#include "viewer/picture.h"

#include <algorithm>
#include <utility>

namespace pellucid::viewer {
namespace {

constexpr vk::Format kFormat = vk::Format::eR8G8B8A8Unorm;

}  // namespace

Picture::Picture(Gpu& gpu, vulkan::Frames& frames) : gpu_(gpu), frames_(frames) { pace_.restart(true); }

bool Picture::stays_equal(const RenderSettings& s) const {
    return wanted_ && wanted_->width == s.width && wanted_->height == s.height && wanted_->technique == s.technique &&
           wanted_->parameters == s.parameters && wanted_->view == s.view && wanted_->samples == s.samples &&
           wanted_->tonemap == s.tonemap && wanted_->exposure_ev == s.exposure_ev && wanted_->light == s.light;
}

void Picture::want(const RenderSettings& settings, bool moving, std::uint64_t revision) {
    if (!stays_equal(settings) || revision != revision_) ++generation_;
    if (!wanted_ || wanted_->technique != settings.technique) pace_.restart(settings.technique != "fast");
    wanted_ = settings;
    revision_ = revision;
    moving_ = moving;
}

bool Picture::still() const {
    if (!wanted_) return true;
    if (failed_generation_ == generation_) return true;
    return shown_ && shown_still_ && shown_generation_ == generation_ && info_.samples >= wanted_->samples;
}

bool Picture::take() {
    if (!flight_) return false;
    std::optional<vulkan::FrameReport> report;
    try {
        report = frames_.read(flight_->ticket);
    } catch (...) {
        failed_generation_ = std::exchange(flight_, std::nullopt)->generation;
        throw;
    }
    if (!report) return false;
    const Flight flight = *std::exchange(flight_, std::nullopt);
    info_.frame_ms = std::chrono::duration<double, std::milli>(Clock::now() - flight.start).count();
    if (!flight.still) pace_.measured(info_.frame_ms);
    info_.samples = report->samples;
    info_.samples_wanted = flight.still ? wanted_->samples : 1;
    if (flight.still && report->samples == 1) still_start_ = flight.start;
    if (flight.still && report->samples == wanted_->samples)
        info_.still_ms = std::chrono::duration<double, std::milli>(Clock::now() - still_start_).count();
    info_.moving = !flight.still;
    info_.pace_changes = pace_.changes();
    info_.pace = flight.pace;
    info_.passes = std::move(report->passes);
    info_.warnings = std::move(report->warnings);
    info_.overflows = std::move(report->overflows);
    shown_ = flight.target;
    shown_extent_ = flight.extent;
    shown_generation_ = flight.generation;
    shown_still_ = flight.still;
    return true;
}

void Picture::submit(const std::function<void()>& wait_for_reads) {
    if (flight_ || !wanted_ || still()) return;
    RenderSettings settings = *wanted_;
    Pace pace{};
    if (moving_) {
        if (shown_ && shown_generation_ == generation_) return;  // already up to date
        pace = pace_.pace();
        settings.width = scaled(settings.width, pace.scale);
        settings.height = scaled(settings.height, pace.scale);
        settings.samples = 1;
        settings.still = false;
        if (pace.coarse) {
            settings.technique = "fast";
            settings.parameters.clear();
        }
    }
    // One of the three images is shown, and the window may still read the previous one.
    std::size_t target = 0;
    while (shown_ == target) ++target;
    DeviceImage& image = targets_[target];
    wait_for_reads();
    if (image.extent.width < wanted_->width || image.extent.height < wanted_->height)
        image = DeviceImage(gpu_, {wanted_->width, wanted_->height}, kFormat,
                            vk::ImageUsageFlagBits::eTransferDst | vk::ImageUsageFlagBits::eTransferSrc);
    const vulkan::Target to{.image = *image.image,
                            .format = VK_FORMAT_R8G8B8A8_UNORM,
                            .layout_after = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    const auto start = Clock::now();
    try {
        const vulkan::Ticket ticket = frames_.submit(settings, to);
        flight_ = {ticket, target, {settings.width, settings.height}, pace, !moving_, generation_, start};
    } catch (...) {
        failed_generation_ = generation_;
        throw;
    }
}

void Picture::finish() {
    if (!flight_) return;
    static_cast<void>(frames_.wait(flight_->ticket));
    flight_.reset();
}

Image Picture::read(Gpu& gpu) const { return read_texels(gpu, image(), kFormat, shown_extent_); }

}  // namespace pellucid::viewer
