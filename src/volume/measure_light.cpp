#include <pellucid/volume_light.h>

#include "volume/upload_volumes.h"
#include "volume/wavefront.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstring>

namespace pellucid {
namespace {

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

std::vector<LightMap> download_maps(Recorder& recorder, const LightVolumes& light) {
    const Buffer copy(recorder.device(), "copy of light on receivers", light.receiver_light.size(),
                      vk::BufferUsageFlagBits::eTransferDst, true);
    recorder.copy(light.receiver_light, copy, copy.size());
    recorder.submit_and_wait();
    std::vector<glm::vec4> texels(copy.size() / sizeof(glm::vec4));
    std::memcpy(texels.data(), copy.mapped(), texels.size() * sizeof(glm::vec4));
    std::vector<LightMap> maps;
    for (const gpu::LightReceiver& receiver : light.receiver_list) {
        LightMap map{.corner = glm::dvec3(receiver.corner),
                     .side = glm::dvec3(receiver.side),
                     .up = glm::dvec3(receiver.up),
                     .texel = double(receiver.corner.w),
                     .irradiance = Image(int(receiver.side.w), int(receiver.up.w), 3)};
        const auto first = std::bit_cast<std::uint32_t>(receiver.normal.w);
        for (std::size_t i = 0; i < map.irradiance.pixels.size(); ++i)
            map.irradiance.pixels[i] = texels[first + i / 3][int(i % 3)];
        maps.push_back(std::move(map));
    }
    return maps;
}

}  // namespace

MeasuredLight measure_light(const DeviceOptions& options, const Scene& scene, const LightSettings& settings,
                            int repetitions) {
    const Device device(options);
    Workspace workspace(device);
    Recorder recorder(device);
    WavefrontTracer tracer(device);
    const VolumeImages volumes = upload_volumes(device, scene);
    std::vector<double> device_ms, wall_ms;
    for (int i = 0; i <= repetitions; ++i) {
        const auto start = std::chrono::steady_clock::now();
        tracer.forget();
        tracer.update(recorder, workspace, scene, volumes, settings);
        double own_ms = 0.0;
        for (const PassTime& pass : recorder.submit_and_wait()) own_ms += pass.time_ms;
        if (i == 0) continue;
        device_ms.push_back(own_ms);
        wall_ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    MeasuredLight measured{.statistics = tracer.statistics(),
                           .device_ms = median(device_ms),
                           .wall_ms = median(wall_ms),
                           .voxel = 1e30,
                           .receivers = download_maps(recorder, tracer.light())};
    for (const VolumeObject& object : scene.volume_objects) {
        const double scale = double(glm::length(glm::vec3(object.world_from_volume[0])));
        measured.voxel = std::min(measured.voxel, scale * double(scene.volumes[std::size_t(object.volume)]->voxel));
    }
    return measured;
}

}  // namespace pellucid
