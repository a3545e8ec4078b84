#pragma once

#include "gpu/memory.h"
#include "gpu/program.h"
#include "gpu/scene_hierarchy.h"

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace pellucid {

/// Programs, and the images, buffers and hierarchy that live for a frame, by name. What a frame asks for
/// is kept for the next one if name and shape agree; trim() frees what no frame has asked for lately.
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

    /// Call once per frame: frees images and buffers that no frame has asked for since the call before the last, or for as
    /// many calls more as keep() says.
    void trim();
    /// At 0, the default, a resize frees the old image before it allocates the new one. With more, frames that alternate
    /// between up to kMostSizes sizes allocate nothing, for the memory of all of them.
    void keep(std::uint32_t frames) { kept_frames_ = frames; }
    static constexpr std::size_t kMostSizes = 4;  ///< of one name
    /// Frees all images, buffers and the hierarchy.
    void clear();

private:
    template <class Resource>
    struct Entry {
        Resource resource;
        std::uint32_t unused = 0;  ///< calls of trim() since it was asked for
    };
    template <class Resource>
    using Entries = std::multimap<std::string, Entry<Resource>, std::less<>>;
    struct HierarchyEntry {
        HierarchyEntry(const Device& device, const GpuScene& scene, StructureUse use) : resource(device, scene, use) {}
        SceneHierarchy resource;
        bool used = true;
    };

    /// The resource of this name that `fits`, or what `make` returns.
    template <class Resource, class Fits, class Make>
    const Resource& kept(Entries<Resource>& entries, std::string_view name, const Fits& fits, const Make& make) {
        const auto [begin, end] = entries.equal_range(name);
        for (auto found = begin; found != end; ++found) {
            if (!fits(found->second.resource)) continue;
            found->second.unused = 0;
            return found->second.resource;
        }
        const auto add = [&]() -> const Resource& {
            return entries.emplace(std::string(name), Entry<Resource>{make()})->second.resource;
        };
        if (kept_frames_ == 0) {
            entries.erase(begin, end);  // freed first: both may not fit
            return add();
        }
        if (std::size_t(std::distance(begin, end)) >= kMostSizes) {
            const auto oldest = std::max_element(
                begin, end, [](const auto& a, const auto& b) { return a.second.unused < b.second.unused; });
            if (oldest->second.unused > 0) entries.erase(oldest);
        }
        try {
            return add();
        } catch (const TooLarge&) {
            drop_older_than(0);
            return add();
        }
    }
    void drop_older_than(std::uint32_t unused);

    /// The program of key_.
    template <class Make>
    const Program& program(const Make& make) {
        const auto found = programs_.find(key_);
        return found != programs_.end() ? found->second : programs_.emplace(key_, make()).first->second;
    }

    const Device& device_;
    std::map<std::string, Program, std::less<>> programs_;
    std::string key_;  ///< of a program: all that it depends on
    std::uint32_t kept_frames_ = 0;
    Entries<GpuImage> images_;
    Entries<Buffer> buffers_;
    std::optional<HierarchyEntry> hierarchy_;
};

}  // namespace pellucid
