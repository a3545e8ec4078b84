#pragma once

#include "gpu/frame.h"
#include "gpu/recorder.h"

#include <span>

namespace pellucid {

/// Tone mapping for an adapting eye: Krawczyk, Myszkowski, Seidel, "Perceptual Effects in Real-time Tone Mapping",
/// Spring Conference on Computer Graphics 2005. The adapted luminance stays on the device between images. An image may
/// consist of parts.
class Adaptation {
public:
    explicit Adaptation(const Device& device);

    struct Look {
        float unit_cd_m2;  ///< luminance of radiance 1, > 0
        float exposure;    ///< factor on the key
        /// time since the previous image, >= 0, may be infinite; the first image is always fully adapted
        float elapsed_s;
    };
    /// Call before the first part of an image. `parts`: sizes of all parts, in the order of add().
    void begin_picture(Workspace& workspace, std::span<const vk::Extent2D> parts);
    /// Adds the luminance of a part to the sum. `radiance`: RGBA32F.
    void add(Recorder& recorder, const Frame& frame, const GpuImage& radiance, const Look& look);
    /// Adapts to the mean of all parts, exp(mean(log(Y + 1e-4 cd/m2))).
    void adapt(Recorder& recorder, const Frame& frame, const Look& look);
    /// Display values (RGBA8, sRGB-encoded) of a part of the adapted image.
    const GpuImage& tonemap(Recorder& recorder, const Frame& frame, const GpuImage& radiance, const Look& look);

    /// Adapted luminance after the last image drawn, cd/m2.
    float adapted_cd_m2() const;

private:
    Buffer adapted_;  ///< one float
    bool first_ = true;
    const Buffer* sums_ = nullptr;  ///< sums of this image
    std::uint32_t added_ = 0;
    float pixels_ = 0.0f;
};

}  // namespace pellucid
