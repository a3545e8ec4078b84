#pragma once

#include <pellucid/pellucid.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace pellucid::cli {

/// Parses `text` as a finite number. Throws Error naming `what` otherwise.
double parse_number(const std::string& what, const std::string& text);

/// Parses "A,B,.." as exactly `count` numbers.
std::vector<double> parse_numbers(const std::string& what, const std::string& text, std::size_t count);

/// Parses "WxH" in pixels, both at least 1.
std::pair<std::uint32_t, std::uint32_t> parse_size(const std::string& text);

/// Parses "NAME=FILE" of --aov; the file must end in .exr.
std::pair<std::string, std::string> parse_aov(const std::string& text);

/// Parses "NAME", a camera of the scene, or "orbit:AZ,EL,DIST[,X,Y,Z]". Angles are in degrees, the distance is in
/// bounding-sphere radii. The target is the scene's centre, or X, Y, Z in the file's world space.
Camera parse_camera(const std::string& text, const Scene& scene, float vertical_fov);

/// `argument` as a shell takes it for one word.
std::string shell_quoted(const std::string& argument);

}  // namespace pellucid::cli
