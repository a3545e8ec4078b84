#pragma once

#include <pellucid/pellucid.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace pellucid::cli {

/// `text` as a finite number. Throws Error naming `what` otherwise.
double parse_number(const std::string& what, const std::string& text);

/// "A,B,.." as exactly `count` numbers.
std::vector<double> parse_numbers(const std::string& what, const std::string& text, std::size_t count);

/// "WxH" in pixels, both at least 1.
std::pair<std::uint32_t, std::uint32_t> parse_size(const std::string& text);

/// "NAME=FILE" of --aov; the file must end in .exr.
std::pair<std::string, std::string> parse_aov(const std::string& text);

/// "NAME", a camera of the scene, or "orbit:AZ,EL,DIST[,X,Y,Z]" in degrees and bounding-sphere radii, about the centre of
/// the scene or a point of the file's world.
Camera parse_camera(const std::string& text, const Scene& scene, float vertical_fov);

}  // namespace pellucid::cli
