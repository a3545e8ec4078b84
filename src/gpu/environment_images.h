#pragma once

#include "gpu/recorder.h"
#include "gpu/structs.h"
#include "gpu/workspace.h"

#include <pellucid/environment.h>

namespace pellucid {

/// Fills the environment part of `constants`, which is everything but the map.
void set_environment(gpu::FrameConstants& constants, const Environment& environment);

/// The environment's map, or one black texel if it is a formula; bound as "environment_map".
GpuImage upload_environment(const Device& device, const Environment& environment);

/// The environment as rough surfaces reflect it, for gpu/filtered_environment.glsl.
struct FilteredEnvironment {
    explicit FilteredEnvironment(const Device& device);
    /// Records the filtering; the images are valid once the recording has run. `map`: result of upload_environment().
    void filter(Workspace& workspace, Recorder& recorder, const Environment& environment, const GpuImage& map) const;

    GpuImage pyramid, filtered;
};

/// A placeholder for scenes without rough surfaces. Its contents are undefined.
GpuImage no_filtered_environment(const Device& device);

}  // namespace pellucid
