#pragma once

// Scenes of volumes under lights, and what the tracing of their light has found.
#include "volume/upload_volumes.h"
#include "volume/wavefront.h"

#include <pellucid/scene.h>

#include "gpu/device_test.h"

#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <vector>

namespace pellucid::test {

inline void place(Scene& scene, Volume volume, glm::mat4 world_from_volume = glm::mat4(1.0f)) {
    VolumeObject object;
    object.volume = int(scene.volumes.size());
    object.world_from_volume = world_from_volume;
    scene.volumes.push_back(std::make_shared<const Volume>(std::move(volume)));
    scene.volume_objects.push_back(object);
}

/// A cube of one medium around the origin.
inline Volume block(unsigned resolution, float edge, float n, glm::vec3 sigma_a) {
    Volume volume;
    volume.name = "block";
    volume.size = glm::uvec3(resolution);
    volume.voxel = edge / float(resolution);
    volume.low = glm::vec3(-0.5f * edge);
    volume.n.assign(volume.voxel_count(), n);
    if (sigma_a != glm::vec3(0.0f)) volume.sigma_a.assign(volume.voxel_count(), sigma_a);
    return volume;
}

/// An opaque rectangle around `center`; side and up span it.
inline void add_plane(Scene& scene, glm::vec3 center, glm::vec3 half_side, glm::vec3 half_up) {
    if (scene.materials.empty()) scene.materials.emplace_back();
    Mesh mesh;
    mesh.positions = {center - half_side - half_up, center + half_side - half_up, center + half_side + half_up,
                      center - half_side + half_up};
    mesh.normals.assign(4, glm::normalize(glm::cross(half_side, half_up)));
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    Object object;
    object.mesh = int(scene.meshes.size());
    scene.meshes.push_back(mesh);
    scene.objects.push_back(object);
}

/// Six of them, around the cube of that half edge.
inline void enclose(Scene& scene, float half) {
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f}) {
            glm::vec3 center(0.0f), side(0.0f), up(0.0f);
            center[axis] = sign * half;
            side[(axis + 1) % 3] = half;
            up[(axis + 2) % 3] = half;
            add_plane(scene, center, side, up);
        }
}

inline Light directional(glm::vec3 direction, glm::vec3 irradiance = glm::vec3(1.0f)) {
    Light light;
    light.kind = Light::Kind::kDirectional;
    light.direction = glm::normalize(direction);
    light.intensity = irradiance;
    return light;
}

inline Light point(glm::vec3 position, glm::vec3 intensity = glm::vec3(1.0f)) {
    Light light;
    light.position = position;
    light.intensity = intensity;
    return light;
}

inline LightSettings without_reflection() {
    LightSettings settings;
    settings.fresnel = false;
    return settings;
}

class Wavefront : public DeviceTest {
protected:
    void SetUp() override {
        DeviceTest::SetUp();
        if (IsSkipped()) return;
        tracer_.emplace(device());
    }
    const LightStatistics& trace(const Scene& scene, const LightSettings& settings = {}) {
        volumes_.emplace(upload_volumes(device(), scene));
        update(scene, settings);
        return tracer_->statistics();
    }
    void update(const Scene& scene, const LightSettings& settings = {}) {
        do {
            EXPECT_TRUE(tracer_->update(recorder(), workspace(), scene, *volumes_, settings));
            time_ms_ = recorder().submit_and_wait().at(0).time_ms;
        } while (tracer_->must_repeat());
    }
    double time_ms() const { return time_ms_; }
    WavefrontTracer& tracer() { return *tracer_; }
    const VolumeImages& volumes() { return *volumes_; }

    std::vector<LandedPhoton> photons() { return tracer_->landed_photons(recorder()); }
    /// Power that arrives on opaque objects, or on one.
    glm::dvec3 power_on_objects(std::optional<std::uint32_t> of = std::nullopt) {
        glm::dvec3 sum(0.0);
        for (const LandedPhoton& photon : photons())
            if (!of || *of == photon.object) sum += photon.flux;
        return sum;
    }
    /// Irradiance in the voxels of the one placement there is.
    std::vector<glm::vec4> voxel_light() {
        const std::vector<std::byte> bytes = download_box(device(), tracer().light().irradiance);
        std::vector<glm::vec4> values(bytes.size() / sizeof(glm::vec4));
        std::memcpy(values.data(), bytes.data(), bytes.size());
        return values;
    }

private:
    std::optional<WavefrontTracer> tracer_;
    std::optional<VolumeImages> volumes_;
    double time_ms_ = 0.0;
};

inline void print(const char* what, const LightStatistics& s) {
    std::printf(
        "%s: emitted %.5f arrived %.5f missed %.5f absorbed %.5f reflected %.5f turned %.5f weak %.5f left %.5f; "
        "%u patches, %u splits, %u rounds, %u refused, %u left\n",
        what, s.emitted.x, s.arrived.x, s.missed.x, s.absorbed.x, s.reflected.x, s.turned.x, s.weak.x, s.left.x,
        s.patches, s.splits, s.rounds, s.refused, s.patches_left);
}

}  // namespace pellucid::test
