#pragma once

#include "gpu/structs.h"
#include "gpu/texture_pages.h"

#include <pellucid/scene.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pellucid {

/// Records with the textures alone, which `textures` gets.
gpu::MaterialRecord textured_record(const Material& material, TextureTable& textures);
gpu::FinishRecord textured_finish(const Finish& finish, TextureTable& textures);

/// Fills all of the records of material `number` but textures.
void update_records(const Material& material, std::size_t number, gpu::MaterialRecord& record,
                    gpu::FinishRecord& finish);

/// Whether an opaque surface needs the shaders of finishes (opaque_surface.glsl).
bool has_finish(const Material& material);

/// Of all meshes' vertices, one after the other, as tangents.glsl reads them; a single 0 where no mesh has any.
std::vector<std::uint32_t> packed_tangents(const Scene& scene);

}  // namespace pellucid
