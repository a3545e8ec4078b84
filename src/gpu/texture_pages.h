#pragma once

#include "gpu/memory.h"
#include "gpu/structs.h"

#include <pellucid/scene.h>

#include <map>
#include <vector>

namespace pellucid {

/// Packs a scene's images into the layers ("pages") of one array image. So any shader reaches any texture without
/// descriptor indexing, which some devices lack.
class TextureTable {
public:
    explicit TextureTable(const Scene& scene) : scene_(scene) {}

    /// Index of a new record for `texture`, or PELLUCID_NO_TEXTURE. `srgb`: decode when sampling.
    std::uint32_t add(const Texture& texture, bool srgb);

    /// Places the images of all records on pages and uploads the pages. Call after the last add().
    /// Throws Error naming an image that is larger than the device allows.
    GpuImage upload_pages(const Device& device);
    /// Complete after upload_pages().
    const std::vector<gpu::TextureRecord>& records() const { return records_; }

private:
    const Scene& scene_;
    std::vector<gpu::TextureRecord> records_;
    std::vector<int> images_;  // per record: index into Scene::images
};

}  // namespace pellucid
