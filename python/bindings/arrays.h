#pragma once

#include <pellucid/pellucid.h>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace pellucid::python {

namespace py = pybind11;

/// Array that owns `values` by a capsule, without a copy. `shape` has one number per dimension.
template <class Value>
py::array owned_array(std::vector<Value>&& values, const py::dtype& type, const std::vector<py::ssize_t>& shape) {
    auto* kept = new std::vector<Value>(std::move(values));
    const py::capsule owner(kept, [](void* pointer) { delete static_cast<std::vector<Value>*>(pointer); });
    return py::array(type, shape, kept->data(), owner);
}

/// float32, shape (height, width, channels), or (height, width) for one channel; owns the pixels, without a copy.
py::array image_array(Image&& image);

/// Array of numbers, in any real type. Throws Error in one line that begins with `what` otherwise.
py::array number_array(const py::handle& object, const std::string& what);

/// Converts an array of shape (height, width) or (height, width, channels). Throws Error naming `what` for another
/// shape or type, and for another number of channels; `channels` 0 accepts any.
Image to_image(const py::handle& object, const std::string& what, int channels = 0);

/// float32 in C order, of shape (any, columns); a copy only where `object` is something else.
using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;
Floats rows_of_floats(const py::handle& object, const std::string& what, py::ssize_t columns);

/// Rows of an array as vectors.
template <class Vector>
std::vector<Vector> to_vectors(const py::handle& object, const std::string& what) {
    const Floats rows = rows_of_floats(object, what, Vector::length());
    const auto* first = reinterpret_cast<const Vector*>(rows.data());
    return {first, first + rows.shape(0)};
}

/// Copies vectors into an array of shape (count, length), of the vectors' own type.
template <class Vector>
py::array from_vectors(const std::vector<Vector>& vectors) {
    using Value = typename Vector::value_type;
    py::array_t<Value> rows({py::ssize_t(vectors.size()), py::ssize_t(Vector::length())});
    std::copy(vectors.begin(), vectors.end(), reinterpret_cast<Vector*>(rows.mutable_data()));
    return rows;
}

/// Converts an integer array of shape (n, 3).
std::vector<glm::uvec3> to_triangles(const py::handle& object, const std::string& what);

/// Sequence of as many numbers as the vector has. Throws Error naming `what` otherwise.
template <class Vector>
Vector to_vector(const py::handle& object, const std::string& what) {
    const py::array_t<double, py::array::c_style | py::array::forcecast> numbers(number_array(object, what));
    if (numbers.ndim() != 1 || numbers.shape(0) != Vector::length())
        throw Error(what + ": must be " + std::to_string(Vector::length()) + " numbers");
    Vector vector;
    for (int i = 0; i < Vector::length(); ++i) vector[i] = static_cast<typename Vector::value_type>(numbers.at(i));
    return vector;
}

template <class Vector>
py::array from_vector(const Vector& vector) {
    return py::array_t<typename Vector::value_type>(py::ssize_t(Vector::length()), &vector[0]);
}

/// Matrices of Python have rows first: `m @ [x, y, z, 1]` transforms a point.
glm::mat4 to_transform(const py::handle& object, const std::string& what);
py::array from_transform(const glm::mat4& transform);

/// float32, shape (voxels along z, y, x), or (..., 3).
std::vector<float> to_grid(const py::handle& object, const std::string& what, glm::uvec3& size, int channels);

/// Mask of pixels: an array of shape (height, width), 0 for pixels that are left out; None: empty.
std::vector<std::uint8_t> to_mask(const py::object& object, const std::string& what);

/// Shape of an array as Python writes it, "(4, 3)".
std::string shape_of(const py::array& array);

/// Number and type of an array in words: "float64 (4, 3)".
std::string describe(const py::array& array);

}  // namespace pellucid::python
