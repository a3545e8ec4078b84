#include <pellucid/measure.h>

#include "core/srgb.h"
#include "measure/flip_map.h"

namespace pellucid {
Image flip_ldr(const Image& reference, const Image& test, double pixels_per_degree) {
    check_flip_input(reference, test, pixels_per_degree);
    Image map(reference.width, reference.height, 1);
    const ShownColor shown = [](glm::vec3 rgb) {
        return glm::vec3(linear_from_srgb(rgb.x), linear_from_srgb(rgb.y), linear_from_srgb(rgb.z));
    };
    raise_to_flip(map, reference, test, shown, pixels_per_degree);
    return map;
}

}  // namespace pellucid
