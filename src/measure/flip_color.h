#pragma once

#include <glm/glm.hpp>

namespace pellucid {

/// Opponent space of FLIP's first stage, YyCxCz (Zhang and Wandell 1997): lightness, red-green and blue-yellow
/// contrast. It is an affine map of linear light, so filters with weights that sum to 1 act equally in both spaces.
glm::vec3 opponent_from_linear(glm::vec3 linear);

/// CIE L*a*b* of a colour in the opponent space, with a* and b* scaled by 0.01 L* for the Hunt effect (colours look
/// paler in the dark). Values outside 0..1 in linear Rec.709 are clipped first, because a display cannot show them.
glm::vec3 perceived_from_opponent(glm::vec3 opponent);

/// Difference of two perceived colours (HyAB, Abasi et al. 2020): city block in lightness, Euclidean in chroma. It is
/// better than CIE76 for large differences.
float perceived_distance(glm::vec3 a, glm::vec3 b);

}  // namespace pellucid
