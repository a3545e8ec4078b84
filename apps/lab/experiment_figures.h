#pragma once

#include "lab/experiments.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace pellucid::cli {

/// Text without what HTML and XML take for markup.
std::string escaped(const std::string& text);

/// Rows and columns of text; the first row is the head.
using TextTable = std::vector<std::vector<std::string>>;

/// A row for each run: scene and variant, where there are several, and the columns that any run has a number for.
TextTable table_of(const std::vector<Column>& columns, const nlohmann::ordered_json& runs);

std::string markdown(const TextTable& table);
std::string html(const TextTable& table);

/// A picture of the plot; empty where it would have less than two points on a line.
std::string plot_svg(const Plot& plot, const nlohmann::ordered_json& runs);

}  // namespace pellucid::cli
