#include "arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace pellucid::python {
namespace {

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

}  // namespace

std::string shape_of(const py::array& array) { return py::str(array.attr("shape")); }

std::string describe(const py::array& array) {
    return fmt::format("{} {}", std::string(py::str(array.dtype())), shape_of(array));
}

py::array image_array(Image&& image) {
    std::vector<py::ssize_t> shape{image.height, image.width};
    if (image.channels != 1) shape.push_back(image.channels);
    return owned_array(std::move(image.pixels), py::dtype::of<float>(), shape);
}

py::array number_array(const py::handle& object, const std::string& what) {
    py::array array = py::array::ensure(object);
    if (!array) {
        PyErr_Clear();
        throw Error(fmt::format("{}: must be an array of numbers, not {}", what, Py_TYPE(object.ptr())->tp_name));
    }
    const char kind = array.dtype().kind();
    if (kind != 'f' && kind != 'i' && kind != 'u')
        throw Error(fmt::format("{}: must be an array of numbers, not {}", what, describe(array)));
    return array;
}

Image to_image(const py::handle& object, const std::string& what, int channels) {
    const Floats pixels(number_array(object, what));
    const int found = pixels.ndim() == 3 ? int(pixels.shape(2)) : 1;
    if ((pixels.ndim() != 2 && pixels.ndim() != 3) || pixels.size() == 0 || (channels != 0 && found != channels))
        throw Error(fmt::format("{}: must be of shape (height, width{}), not {}", what,
                                channels == 0   ? "[, channels]"
                                : channels == 1 ? ""
                                                : fmt::format(", {}", channels),
                                shape_of(pixels)));
    Image image;
    image.width = int(pixels.shape(1));
    image.height = int(pixels.shape(0));
    image.channels = found;
    image.pixels.assign(pixels.data(), pixels.data() + pixels.size());
    return image;
}

Floats rows_of_floats(const py::handle& object, const std::string& what, py::ssize_t columns) {
    const py::array array = number_array(object, what);
    if (array.ndim() != 2 || array.shape(1) != columns)
        throw Error(fmt::format("{}: must be of shape (n, {}), not {}", what, columns, shape_of(array)));
    return Floats(array);
}

std::vector<glm::uvec3> to_triangles(const py::handle& object, const std::string& what) {
    const py::array array = number_array(object, what);
    if (array.dtype().kind() == 'f' || array.ndim() != 2 || array.shape(1) != 3)
        throw Error(fmt::format("{}: must be integers of shape (n, 3), not {}", what, describe(array)));
    const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> indices(array);
    const std::int64_t* first = indices.data();
    constexpr std::int64_t kLast = std::numeric_limits<std::uint32_t>::max();
    const auto wrong = std::find_if(first, first + indices.size(), [](std::int64_t i) { return i < 0 || i > kLast; });
    if (wrong != first + indices.size())
        throw Error(
            fmt::format("{}: row {} refers to vertex {}, which is not there", what, (wrong - first) / 3, *wrong));
    std::vector<glm::uvec3> triangles(std::size_t(indices.shape(0)));
    for (std::size_t i = 0; i < triangles.size(); ++i)
        triangles[i] = glm::uvec3(first[3 * i], first[3 * i + 1], first[3 * i + 2]);
    return triangles;
}

glm::mat4 to_transform(const py::handle& object, const std::string& what) {
    const Doubles rows(number_array(object, what));
    if (rows.ndim() != 2 || rows.shape(0) != 4 || rows.shape(1) != 4)
        throw Error(fmt::format("{}: must be of shape (4, 4), not {}", what, shape_of(rows)));
    glm::mat4 transform;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) transform[column][row] = float(rows.at(row, column));
    if (glm::vec4(transform[0][3], transform[1][3], transform[2][3], transform[3][3]) != glm::vec4(0, 0, 0, 1))
        throw Error(fmt::format("{}: the last row must be 0, 0, 0, 1", what));
    return transform;
}

py::array from_transform(const glm::mat4& transform) {
    py::array_t<float> rows({4, 4});
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) rows.mutable_at(row, column) = transform[column][row];
    return rows;
}

std::vector<float> to_grid(const py::handle& object, const std::string& what, glm::uvec3& size, int channels) {
    const Floats grid(number_array(object, what));
    const bool fits = grid.ndim() == (channels == 1 ? 3 : 4) && (channels == 1 || grid.shape(3) == channels);
    if (!fits)
        throw Error(
            fmt::format("{}: must be of shape (z, y, x{}), not {}", what, channels == 1 ? "" : ", 3", shape_of(grid)));
    const glm::uvec3 found(grid.shape(2), grid.shape(1), grid.shape(0));
    if (size != glm::uvec3(0) && size != found)
        throw Error(fmt::format("{}: has {}x{}x{} voxels along x, y and z, another field has {}x{}x{}", what, found.x,
                                found.y, found.z, size.x, size.y, size.z));
    size = found;
    return {grid.data(), grid.data() + grid.size()};
}

std::vector<std::uint8_t> to_mask(const py::object& object, const std::string& what) {
    if (object.is_none()) return {};
    const py::array array = py::array::ensure(object);
    if (!array || array.ndim() != 2) {
        PyErr_Clear();
        throw Error(fmt::format("{}: must be of shape (height, width)", what));
    }
    const py::array_t<bool, py::array::c_style | py::array::forcecast> mask(array);
    return {mask.data(), mask.data() + mask.size()};
}

}  // namespace pellucid::python
