#pragma once

#include "gpu/frame.h"
#include "gpu/recorder.h"

#include <span>

namespace pellucid {

/// Tone mapping for an eye that adapts to what it sees: Krawczyk, Myszkowski, Seidel, "Perceptual Effects in Real-time
/// Tone Mapping", Spring Conference on Computer Graphics 2005. What it has adapted to stays on the device from one
/// picture to the next. A picture may come in parts.
class Adaptation {
public:
    explicit Adaptation(const Device& device);

    struct Look {
        float unit_cd_m2;  ///< luminance of radiance 1, > 0
        float exposure;    ///< factor on the key
        float elapsed_s;   ///< since the picture before, >= 0, or infinite; the first picture is always adapted to
    };
    /// Before the first part of a picture; `parts` are the sizes of all, in the order of add().
    void begin_picture(Workspace& workspace, std::span<const vk::Extent2D> parts);
    /// Adds up the luminance of a part: `radiance` (RGBA32F).
    void add(Recorder& recorder, const Frame& frame, const GpuImage& radiance, const Look& look);
    /// Adapts to the mean of all parts, exp(mean(log(Y + 1e-4 cd/m2))).
    void adapt(Recorder& recorder, const Frame& frame, const Look& look);
    /// Display values (RGBA8, sRGB-encoded) of a part of the picture that has been adapted to.
    const GpuImage& tonemap(Recorder& recorder, const Frame& frame, const GpuImage& radiance, const Look& look);

    /// After the last picture that has been drawn, cd/m2.
    float adapted_cd_m2() const;

private:
    Buffer adapted_;  ///< one float
    bool first_ = true;
    const Buffer* sums_ = nullptr;  ///< of this picture
    std::uint32_t added_ = 0;
    float pixels_ = 0.0f;
};

}  // namespace pellucid
