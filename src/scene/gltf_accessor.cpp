// Accessors of glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021, section 3.6.2), checked
// against the size of their data, which tinygltf does not do.
#include "scene/gltf_accessor.h"

#include "core/fail.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace pellucid {
namespace {

/// `count` elements of `components` values each, `stride` bytes from one to the next.
struct Elements {
    const std::byte* data = nullptr;  ///< null: all values are zero
    std::size_t count = 0;
    std::size_t stride = 0;
    int component_type = 0;
    int components = 0;
    bool normalized = false;
};

/// "mesh cup primitive 0 POSITION (accessor 3)".
std::string with_number(const std::string& user, int accessor) {
    return fmt::format("{} (accessor {})", user, accessor);
}

const tinygltf::Accessor& accessor_at(const GltfFile& gltf, int index, const std::string& user) {
    if (index < 0 || std::size_t(index) >= gltf.model.accessors.size())
        fail(gltf.path, fmt::format("{}: there is no accessor {}", user, index));
    return gltf.model.accessors[std::size_t(index)];
}

std::size_t element_size(const GltfFile& gltf, int component_type, int components, const std::string& user) {
    const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component_type));
    if (size <= 0 || component_type == TINYGLTF_COMPONENT_TYPE_DOUBLE || component_type == TINYGLTF_COMPONENT_TYPE_INT)
        fail(gltf.path, fmt::format("{}: unknown component type {}", user, component_type));
    return std::size_t(size) * std::size_t(components);
}

/// Places `elements` into a buffer view after checking that all of them fit.
void place(const GltfFile& gltf, int buffer_view, std::size_t offset, std::size_t size, Elements& elements,
           const std::string& user) {
    const std::span<const std::byte> bytes = gltf.view(buffer_view, user);
    const std::size_t stride = gltf.model.bufferViews[std::size_t(buffer_view)].byteStride;
    elements.stride = stride == 0 ? size : stride;
    if (elements.stride < size)
        fail(gltf.path, fmt::format("{}: byteStride {} is less than the element size {}", user, stride, size));
    if (elements.count > 0 && (offset > bytes.size() || size > bytes.size() - offset ||
                               elements.count - 1 > (bytes.size() - offset - size) / elements.stride))
        fail(gltf.path, fmt::format("{}: {} elements reach beyond the {} bytes of buffer view {}", user, elements.count,
                                    bytes.size(), buffer_view));
    elements.data = bytes.data() + offset;
}

/// Of `components` values each; anything else is an error.
Elements elements_of(const GltfFile& gltf, const tinygltf::Accessor& accessor, int components,
                     const std::string& user) {
    Elements elements;
    elements.count = accessor.count;
    elements.component_type = accessor.componentType;
    elements.components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    if (elements.components != components)
        fail(gltf.path, fmt::format("{}: has {} components, must have {}", user, elements.components, components));
    elements.normalized = accessor.normalized;
    const std::size_t size = element_size(gltf, accessor.componentType, elements.components, user);
    if (accessor.bufferView >= 0) {
        place(gltf, accessor.bufferView, accessor.byteOffset, size, elements, user);
    } else if (accessor.count > (std::size_t(1) << 24)) {
        // Zeros cost nothing in the file but memory here.
        fail(gltf.path, fmt::format("{}: {} elements without data", user, accessor.count));
    }
    gltf.memory.take(elements.count, std::size_t(components) * sizeof(float));
    return elements;
}

template <typename T>
float to_float(T value, bool normalized) {
    if constexpr (std::is_integral_v<T>) {
        if (normalized) {
            constexpr double kMax = double(std::numeric_limits<T>::max());
            return static_cast<float>(std::max(double(value) / kMax, -1.0));
        }
    }
    return static_cast<float>(value);
}

template <typename T>
void convert_as(const Elements& elements, float* out) {
    for (std::size_t i = 0; i < elements.count; ++i) {
        for (int k = 0; k < elements.components; ++k) {
            T value;  // copied, since files do not always keep to alignment
            std::memcpy(&value, elements.data + i * elements.stride + std::size_t(k) * sizeof(T), sizeof(T));
            *out++ = to_float(value, elements.normalized);
        }
    }
}

void convert(const Elements& elements, float* out) {
    if (!elements.data) return;
    switch (elements.component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return convert_as<std::int8_t>(elements, out);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return convert_as<std::uint8_t>(elements, out);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return convert_as<std::int16_t>(elements, out);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return convert_as<std::uint16_t>(elements, out);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return convert_as<std::uint32_t>(elements, out);
        default:
            return convert_as<float>(elements, out);
    }
}

std::vector<std::uint32_t> integers(const GltfFile& gltf, const Elements& elements, const std::string& user) {
    std::vector<std::uint32_t> values(elements.count, 0);
    if (!elements.data) return values;
    const auto copy = [&](auto value) {
        for (std::size_t i = 0; i < elements.count; ++i) {
            std::memcpy(&value, elements.data + i * elements.stride, sizeof value);
            values[i] = value;
        }
    };
    switch (elements.component_type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            copy(std::uint8_t());
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            copy(std::uint16_t());
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            copy(std::uint32_t());
            break;
        default:
            fail(gltf.path, fmt::format("{}: indices must be unsigned integers", user));
    }
    return values;
}

/// The elements that a sparse accessor replaces.
struct Replacements {
    std::vector<std::uint32_t> indices;  ///< less than the accessor's count
    Elements values;
};

Replacements replacements_of(const GltfFile& gltf, const tinygltf::Accessor& accessor, const Elements& base,
                             const std::string& user) {
    const auto& sparse = accessor.sparse;
    if (sparse.count < 0 || std::size_t(sparse.count) > base.count || sparse.indices.byteOffset < 0 ||
        sparse.values.byteOffset < 0)
        fail(gltf.path, fmt::format("{}: sparse accessor is malformed", user));
    Elements which = base, values = base;
    which.count = values.count = std::size_t(sparse.count);
    which.component_type = sparse.indices.componentType;
    which.components = 1;
    place(gltf, sparse.indices.bufferView, std::size_t(sparse.indices.byteOffset),
          element_size(gltf, which.component_type, 1, user), which, user);
    place(gltf, sparse.values.bufferView, std::size_t(sparse.values.byteOffset),
          element_size(gltf, values.component_type, values.components, user), values, user);
    Replacements replacements{integers(gltf, which, user), values};
    for (const std::uint32_t index : replacements.indices)
        if (index >= base.count) fail(gltf.path, fmt::format("{}: sparse index {} of {}", user, index, base.count));
    return replacements;
}

void replace_sparse(const GltfFile& gltf, const tinygltf::Accessor& accessor, const Elements& base, float* out,
                    const std::string& user) {
    const Replacements replacements = replacements_of(gltf, accessor, base, user);
    const std::size_t width = std::size_t(base.components);
    std::vector<float> values(replacements.values.count * width);
    convert(replacements.values, values.data());
    for (std::size_t i = 0; i < replacements.indices.size(); ++i)
        std::copy_n(values.begin() + std::ptrdiff_t(i * width), width, out + replacements.indices[i] * width);
}

/// All values of an accessor; `out` holds zeros.
void read_into(const GltfFile& gltf, const tinygltf::Accessor& accessor, const Elements& elements, float* out,
               const std::string& user) {
    convert(elements, out);
    if (accessor.sparse.isSparse) replace_sparse(gltf, accessor, elements, out, user);
}

}  // namespace

template <int N>
std::vector<glm::vec<N, float>> read_vectors(const GltfFile& gltf, int accessor, const std::string& user) {
    const tinygltf::Accessor& a = accessor_at(gltf, accessor, user);
    const Elements elements = elements_of(gltf, a, N, with_number(user, accessor));
    std::vector<glm::vec<N, float>> vectors(elements.count, glm::vec<N, float>(0.0f));
    static_assert(sizeof(glm::vec<N, float>) == N * sizeof(float));
    if (!vectors.empty()) read_into(gltf, a, elements, &vectors.front()[0], user);
    return vectors;
}

template std::vector<glm::vec2> read_vectors<2>(const GltfFile&, int, const std::string&);
template std::vector<glm::vec3> read_vectors<3>(const GltfFile&, int, const std::string&);
template std::vector<glm::vec4> read_vectors<4>(const GltfFile&, int, const std::string&);

std::vector<float> read_fractions(const GltfFile& gltf, int accessor, int components, const std::string& user) {
    const tinygltf::Accessor& a = accessor_at(gltf, accessor, user);
    const Elements elements = elements_of(gltf, a, components, with_number(user, accessor));
    if (elements.component_type != TINYGLTF_COMPONENT_TYPE_FLOAT && !elements.normalized)
        fail(gltf.path, fmt::format("{}: must be floats or normalized integers", user));
    std::vector<float> values(elements.count * std::size_t(components), 0.0f);
    if (!values.empty()) read_into(gltf, a, elements, values.data(), user);
    if (!std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); }))
        fail(gltf.path, fmt::format("{}: a number is not finite", user));
    return values;
}

std::vector<float> read_floats(const GltfFile& gltf, int accessor, int components, const std::string& user) {
    if (accessor_at(gltf, accessor, user).componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
        fail(gltf.path, fmt::format("{}: must be floats", user));
    return read_fractions(gltf, accessor, components, user);
}

std::vector<glm::uvec4> read_joints(const GltfFile& gltf, int accessor, const std::string& user) {
    const tinygltf::Accessor& a = accessor_at(gltf, accessor, user);
    if (a.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
        a.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT)
        fail(gltf.path, fmt::format("{}: must be unsigned bytes or shorts", user));
    if (a.normalized) fail(gltf.path, fmt::format("{}: indices cannot be normalized", user));
    const std::vector<glm::vec4> exact = read_vectors<4>(gltf, accessor, user);  // 16 bits fit into a float
    return {exact.begin(), exact.end()};
}

int component_count(const GltfFile& gltf, int accessor) {
    if (accessor < 0 || std::size_t(accessor) >= gltf.model.accessors.size()) return 0;
    return tinygltf::GetNumComponentsInType(
        static_cast<std::uint32_t>(gltf.model.accessors[std::size_t(accessor)].type));
}

std::vector<std::uint32_t> read_indices(const GltfFile& gltf, int accessor, const std::string& user) {
    const tinygltf::Accessor& a = accessor_at(gltf, accessor, user);
    const std::string who = with_number(user, accessor);
    const Elements elements = elements_of(gltf, a, 1, who);
    std::vector<std::uint32_t> values = integers(gltf, elements, who);
    if (!a.sparse.isSparse) return values;
    const Replacements replacements = replacements_of(gltf, a, elements, who);
    const std::vector<std::uint32_t> replaced = integers(gltf, replacements.values, who);
    for (std::size_t i = 0; i < replaced.size(); ++i) values[replacements.indices[i]] = replaced[i];
    return values;
}

}  // namespace pellucid
