#include "scene/shapes/shape_arguments.h"

#include <pellucid/names.h>

#include "core/fail.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace pellucid {

std::string in_quotes(std::string_view text) { return fmt::format("'{}'", shortened(text)); }

ShapeArguments::ShapeArguments(const ShapeInfo& info, std::string_view text, std::string_view kind)
    : info_(info), kind_(kind) {
    for (const ShapeParameter& parameter : info.parameters) values_.push_back(parameter.default_value);
    std::vector<bool> given(values_.size(), false);

    while (!text.empty()) {
        text.remove_prefix(1);  // the comma
        const std::string_view item = text.substr(0, text.find(','));
        text.remove_prefix(item.size());

        const std::size_t equals = item.find('=');
        if (equals == std::string_view::npos) fail("expected PARAMETER=VALUE, not " + in_quotes(item));
        const std::string_view name = item.substr(0, equals), digits = item.substr(equals + 1);
        const std::size_t i = index(name);
        if (given[i]) fail(fmt::format("{} is given twice", name));
        given[i] = true;

        double value = 0.0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(value))
            fail(fmt::format("{} is {}, not a number", name, in_quotes(digits)));
        const ShapeParameter& parameter = info.parameters[i];
        if (value < parameter.minimum || value > parameter.maximum)
            fail(fmt::format("{} is {}, outside {} to {}", name, digits, parameter.minimum, parameter.maximum));
        values_[i] = value;
    }
}

double ShapeArguments::number(std::string_view parameter) const { return values_[index(parameter)]; }

int ShapeArguments::whole(std::string_view parameter) const {
    const double value = number(parameter);
    if (value != std::floor(value)) fail(fmt::format("{} is {}, not a whole number", parameter, value));
    return int(value);
}

void ShapeArguments::fail(const std::string& message) const {
    throw Error(fmt::format("{} '{}': {}", kind_, info_.name, message));
}

std::size_t ShapeArguments::index(std::string_view parameter) const {
    std::vector<std::string_view> known;
    for (std::size_t i = 0; i < info_.parameters.size(); ++i) {
        if (info_.parameters[i].name == parameter) return i;
        known.push_back(info_.parameters[i].name);
    }
    fail(unknown_name("parameter", shortened(parameter), known).what());
}

}  // namespace pellucid
