#include <pellucid/volume_light.h>

#include "volume/upload_volumes.h"
#include "volume/wavefront.h"

#include <algorithm>
#include <chrono>
#include <cstring>

namespace pellucid {
namespace {

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

}  // namespace

std::vector<LandedPhoton> WavefrontTracer::landed_photons(Recorder& recorder) const {
    const Buffer& list = photons_[shown_].store.photons();
    const Buffer copy(device_, "copy of photons", list.size(), vk::BufferUsageFlagBits::eTransferDst, true);
    recorder.copy(list, copy, copy.size());
    recorder.submit_and_wait();
    std::uint32_t count = 0;
    std::memcpy(&count, copy.mapped(), sizeof(count));
    std::vector<Photon> photons(std::min<std::size_t>(count, photons_[shown_].store.capacity()));
    std::memcpy(photons.data(), copy.mapped() + kPhotonListHeader, photons.size() * sizeof(Photon));
    std::vector<LandedPhoton> landed;
    for (const Photon& photon : photons) {
        const glm::dvec3 flux(photon.flux);
        if (flux.x + flux.y + flux.z > 0.0)
            landed.push_back({glm::dvec3(photon.position), flux, double(photon.radius), photon.object});
    }
    return landed;
}

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
        if (tracer.must_repeat()) --i;
        if (i <= 0) continue;
        device_ms.push_back(own_ms);
        wall_ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    MeasuredLight measured{.statistics = tracer.statistics(),
                           .device_ms = median(device_ms),
                           .wall_ms = median(wall_ms),
                           .voxel = 1e30,
                           .photons = tracer.landed_photons(recorder)};
    for (const VolumeObject& object : scene.volume_objects) {
        const double scale = double(glm::length(glm::vec3(object.world_from_volume[0])));
        measured.voxel = std::min(measured.voxel, scale * double(scene.volumes[std::size_t(object.volume)]->voxel));
    }
    return measured;
}

}  // namespace pellucid
