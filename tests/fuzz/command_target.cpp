#include "cli/command_line.h"
#include "fuzz/fuzz_target.h"
#include "options/arguments.h"
#include "options/options.h"

namespace pellucid::test {
namespace {

/// What commands do with the text of an option.
void parse_values(const std::string& text) {
    using namespace cli;
    TranslucencyArguments translucency;
    translucency.translucent = text;
    TranslucencyArguments lights;
    lights.lights = {text};
    const std::array<std::function<void()>, 6> parsers = {[&] { parse_number("--x", text); },
                                                          [&] { parse_numbers("--x", text, 3); },
                                                          [&] { parse_size(text); },
                                                          [&] { parse_translucency(translucency); },
                                                          [&] { parse_lights(lights, glm::dvec3(0.0)); },
                                                          [&] { parse_parameter("estimator", text); }};
    for (const auto& parse : parsers) {
        try {
            parse();
        } catch (const Error&) {
        }
    }
}

CLI::App& commands() {
    static CLI::App app;
    if (!app.get_subcommands({}).empty()) return app;
    cli::add_commands(app, "");
    app.parse_complete_callback([] { throw CLI::Success(); });  // before any command runs
    return app;
}

void parse_command_line(const std::string& file) {
    std::vector<std::string> words = {"pellucid"};
    std::ifstream stream(file, std::ios::binary);
    for (std::string line; std::getline(stream, line);) words.push_back(line);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    for (const std::string& word : words) parse_values(word);
    try {
        cli::parse_arguments(commands(), int(words.size()), arguments.data());
    } catch (const CLI::ParseError& error) {
        cli::usage_error(commands(), error, int(words.size()), arguments.data());
    }
}

constexpr FuzzTarget kTarget[] = {{"command", "arguments", parse_command_line}};

}  // namespace

std::span<const FuzzTarget> command_targets() { return kTarget; }

}  // namespace pellucid::test
