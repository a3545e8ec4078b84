#pragma once

#include "gpu/acceleration_structure.h"
#include "gpu/memory.h"
#include "gpu/program.h"

#include <initializer_list>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace pellucid {

enum class Access { kRead, kWrite, kReadWrite };

/// A resource bound to a shader's binding of the same name.
struct Binding {
    std::string_view name;
    Access access;
    const Buffer* buffer = nullptr;
    const GpuImage* image = nullptr;
    std::optional<std::uint32_t> layer = {};  ///< bind one layer as a 2D image; default: all, as an array
    const AccelerationStructure* structure = nullptr;
    const std::vector<Binding>* group = nullptr;  ///< see all_of()
};
inline Binding reads(std::string_view name, const Buffer& b) { return {name, Access::kRead, &b, nullptr, {}}; }
inline Binding reads(std::string_view name, const GpuImage& i) { return {name, Access::kRead, nullptr, &i, {}}; }
inline Binding reads_layer(std::string_view name, const GpuImage& i, std::uint32_t layer) {
    return {name, Access::kRead, nullptr, &i, layer};
}
inline Binding reads(std::string_view name, const AccelerationStructure& s) {
    return {name, Access::kRead, nullptr, nullptr, {}, &s};
}
inline Binding writes(std::string_view name, const Buffer& b) { return {name, Access::kWrite, &b, nullptr, {}}; }
inline Binding writes(std::string_view name, const GpuImage& i) { return {name, Access::kWrite, nullptr, &i, {}}; }
inline Binding updates(std::string_view name, const Buffer& b) { return {name, Access::kReadWrite, &b, nullptr, {}}; }
inline Binding updates(std::string_view name, const GpuImage& i) { return {name, Access::kReadWrite, nullptr, &i, {}}; }

/// Represents the bindings of a group that the shader declares, with the access that the shader declares.
inline Binding all_of(const std::vector<Binding>& group) { return {.name = {}, .access = {}, .group = &group}; }

/// The bindings of a pass, from a list in braces, a span or a vector.
struct Bindings : std::span<const Binding> {
    Bindings(std::initializer_list<Binding> list) : std::span<const Binding>(list.begin(), list.size()) {}
    Bindings(std::span<const Binding> row) : std::span<const Binding>(row) {}
    Bindings(const std::vector<Binding>& row) : std::span<const Binding>(row) {}
};

/// The binding of a pass for a slot of its program. Throws std::logic_error, naming both sides, if it is missing or of
/// the wrong kind.
const Binding& binding_of(const Program& program, const BindingSlot& slot, Bindings bindings);
/// Checks the pass's own bindings. Throws std::logic_error if the shaders do not declare one, or declare another
/// access, or if a name is bound twice.
void check_own(const Program& program, Bindings bindings);

/// The stages in which shaders use a slot, and their access.
vk::PipelineStageFlags2 stages_of(const BindingSlot& slot);
vk::AccessFlags2 access_of(const BindingSlot& slot);

}  // namespace pellucid
