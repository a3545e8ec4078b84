#pragma once

#include "gpu/frame.h"
#include "gpu/recorder.h"

namespace pellucid {

/// Tone mapping for an eye that adapts to what it sees: Krawczyk, Myszkowski, Seidel, "Perceptual Effects in Real-time
/// Tone Mapping", Spring Conference on Computer Graphics 2005. What it has adapted to stays on the device from one
/// picture to the next.
class Adaptation {
public:
    explicit Adaptation(const Device& device);

    struct Look {
        float unit_cd_m2;  ///< luminance of radiance 1, > 0
        float exposure;    ///< factor on the key
        float elapsed_s;   ///< since the picture before, >= 0, or infinite; the first picture is always adapted to
    };
    /// Display values (RGBA8, sRGB-encoded) of `radiance` (RGBA32F), after adapting to it. The mean is that of the whole
    /// picture, exp(mean(log(Y + 1e-4 cd/m2))).
    const GpuImage& tonemap(Recorder& recorder, const Frame& frame, const GpuImage& radiance, const Look& look);

    /// After the last picture that has been drawn, cd/m2.
    float adapted_cd_m2() const;

private:
    Buffer adapted_;  ///< one float
    bool first_ = true;
};

}  // namespace pellucid
