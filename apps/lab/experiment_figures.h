#pragma once

#include "lab/experiments.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace pellucid::cli {

/// Escapes the special characters of HTML and XML.
std::string escaped(const std::string& text);

/// Rows and columns of text; the first row is the head.
using TextTable = std::vector<std::vector<std::string>>;

/// One row per run: scene and variant, if there are several, and the columns for which any run has a number.
TextTable table_of(const std::vector<Column>& columns, const nlohmann::ordered_json& runs);

std::string markdown(const TextTable& table);
std::string html(const TextTable& table);

/// The plot as SVG; empty if every line has fewer than two points.
std::string plot_svg(const Plot& plot, const nlohmann::ordered_json& runs);

}  // namespace pellucid::cli
