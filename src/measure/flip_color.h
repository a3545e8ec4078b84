#pragma once

#include <glm/glm.hpp>

namespace pellucid {

/// Opponent space of the first stage of FLIP, YyCxCz (Zhang and Wandell 1997): lightness, red-green and blue-yellow
/// contrast. An affine map of linear light, so that filters with weights that sum to 1 mean the same in both.
glm::vec3 opponent_from_linear(glm::vec3 linear);

/// CIE L*a*b*, a* and b* scaled by 0.01 L* for the Hunt effect (colours look paler in the dark), of a colour in the
/// opponent space. What lies outside 0..1 in linear Rec.709 is clipped first: a display cannot show it.
glm::vec3 perceived_from_opponent(glm::vec3 opponent);

/// Difference of two perceived colours (HyAB, Abasi et al. 2020): city block in lightness, Euclidean in chroma;
/// better than CIE76 for large differences.
float perceived_distance(glm::vec3 a, glm::vec3 b);

}  // namespace pellucid
