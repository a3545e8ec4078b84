#pragma once

#include "gpu/memory.h"
#include "gpu/program.h"
#include "gpu/scene_hierarchy.h"

#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace pellucid {

/// Programs, and the images, buffers and hierarchy that live for a frame, by name. What a frame asks for
/// is kept for the next one if name and shape agree; what a frame did not ask for is freed by trim().
class Workspace {
public:
    explicit Workspace(const Device& device) : device_(device) {}

    const Device& device() const { return device_; }

    /// Programs are made once and kept.
    const Program& compute(ShaderCode shader, std::span<const Constant> constants);
    const Program& compute(ShaderCode shader, std::initializer_list<Constant> constants = {}) {
        return compute(shader, std::span(constants));
    }
    const Program& graphics(const Program::Graphics& state);

    /// Contents are undefined until written in this frame.
    const GpuImage& image(std::string_view name, vk::Format format, vk::Extent2D extent, std::uint32_t layers = 1);
    const Buffer& buffer(std::string_view name, vk::DeviceSize size, bool host_visible = false,
                         vk::Format texels = vk::Format::eUndefined);
    /// There is one at a time: of the scene and the use asked for last.
    SceneHierarchy& hierarchy(const GpuScene& scene, StructureUse use);

    /// Frees what has not been asked for since the last call. No frame may be in flight.
    void trim();

private:
    template <class Resource>
    struct Entry {
        Resource resource;
        bool used = true;
    };
    struct HierarchyEntry {
        HierarchyEntry(const Device& device, const GpuScene& scene, StructureUse use) : resource(device, scene, use) {}
        SceneHierarchy resource;
        bool used = true;
    };

    /// The program of key_.
    template <class Make>
    const Program& program(const Make& make) {
        const auto found = programs_.find(key_);
        return found != programs_.end() ? found->second : programs_.emplace(key_, make()).first->second;
    }

    const Device& device_;
    std::map<std::string, Program, std::less<>> programs_;
    std::string key_;  ///< of a program: all that it depends on
    std::map<std::string, Entry<GpuImage>, std::less<>> images_;
    std::map<std::string, Entry<Buffer>, std::less<>> buffers_;
    std::optional<HierarchyEntry> hierarchy_;
};

}  // namespace pellucid
