#pragma once

#include <pellucid/scene.h>

#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// The values of one shape's parameters: defaults, overridden by `,PARAMETER=VALUE...`.
class ShapeArguments {
public:
    /// `text` is what follows the shape's name, beginning with a comma, or empty.
    /// `kind` stands before its name in messages. Throws Error for what is unknown, repeated, malformed or out of range.
    ShapeArguments(const ShapeInfo& info, std::string_view text, std::string_view kind = "shape");

    double number(std::string_view parameter) const;
    /// Throws Error if the value has a fraction.
    int whole(std::string_view parameter) const;
    /// Throws Error `KIND 'NAME': message`: values that are fine one by one and not together.
    [[noreturn]] void fail(const std::string& message) const;

private:
    std::size_t index(std::string_view parameter) const;

    const ShapeInfo& info_;
    std::string_view kind_;
    std::vector<double> values_;
};

/// `text` shortened, in quotes.
std::string in_quotes(std::string_view text);

}  // namespace pellucid
