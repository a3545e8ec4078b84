#include "volume/scene_volumes.h"

#include "gpu/punctual_light.h"
#include "volume/upload_volumes.h"
#include "volume/voxelize.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <span>

namespace pellucid {

void SceneVolumes::bring_up_to_date(const Scene& scene, GpuScene& gpu_scene,
                                    const std::optional<VoxelSettings>& voxels) {
    scene_ = &scene;
    const std::string made_of =
        voxels ? fmt::format("{} {} {}", voxels->resolution, voxels->smoothing, voxels->samples) : "volumes alone";
    if (made_of == made_of_ && moves_ == gpu_scene.moves) return;
    Scene drawn;
    drawn.volumes = scene.volumes;
    drawn.volume_objects = scene.volume_objects;
    warnings_.clear();
    if (voxels) {
        VoxelizedScene made = voxelize(device_, scene, *voxels);
        warnings_ = std::move(made.warnings);
        VolumeObject object;
        object.name = "glass";
        object.volume = int(drawn.volumes.size());
        for (std::size_t i = 0; i < scene.objects.size(); ++i)
            if (scene.materials[std::size_t(scene.objects[i].material)].refractive()) object.objects.push_back(int(i));
        drawn.volumes.push_back(std::make_shared<const Volume>(std::move(made.volume)));
        drawn.volume_objects.push_back(std::move(object));
    }
    images_ = upload_volumes(device_, drawn);
    std::vector<int> replaced;
    for (const VolumeObject& object : drawn.volume_objects)
        replaced.insert(replaced.end(), object.objects.begin(), object.objects.end());
    gpu_scene.topology->mark_replaced(device_, replaced);

    made_of_ = made_of;
    moves_ = gpu_scene.moves;
}

void SceneVolumes::bring_lights_up_to_date() {
    std::vector<PunctualLight> lights;
    for (const Light& light : tracer_.lights()) lights.push_back(punctual_light(light));
    const std::span<const std::byte> bytes = std::as_bytes(std::span(lights));
    if (std::equal(bytes.begin(), bytes.end(), light_bytes_.begin(), light_bytes_.end())) return;
    light_bytes_.assign(bytes.begin(), bytes.end());
    if (lights.empty()) return;
    lights_ = Buffer(device_, "lights", bytes.size(),
                     vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst);
    upload(device_, lights_, bytes);
}

void SceneVolumes::light(Recorder& recorder, Workspace& workspace, const LightSettings& settings) {
    tracer_.update(recorder, workspace, *scene_, images_, settings, moves_);
    bring_lights_up_to_date();
}

std::vector<std::string> SceneVolumes::warnings() const {
    std::vector<std::string> lines = warnings_;
    if (!lit()) {
        if (const std::size_t count = scene_->lights.size(); count > 0)
            lines.push_back(
                fmt::format("{} light{} not drawn: there is no volume", count, count == 1 ? " is" : "s are"));
        return lines;
    }
    lines.emplace_back(
        "lights shine through volumes and on opaque objects, which cast shadows in the light of volumes only");
    const std::vector<std::string> of_light = tracer_.statistics().warnings();
    lines.insert(lines.end(), of_light.begin(), of_light.end());
    return lines;
}

}  // namespace pellucid
