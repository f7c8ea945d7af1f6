#include "viewer/displays/json_text.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

namespace viewer {

gi::Yaml parse_placed_json(std::string const& text, std::string const& file, std::string const& root)
{
    try {
        return gi::Yaml::parse(text, file, root);
    } catch (gi::InputError const&) { // its message is about YAML, but the file is meant to be JSON
        try {
            [[maybe_unused]] auto const json = nlohmann::json::parse(text);
        } catch (nlohmann::json::parse_error const& e) {
            std::string_view const read = std::string_view(text).substr(0, e.byte > 0 ? e.byte - 1 : 0);
            auto const line_start = read.rfind('\n') + 1; // npos + 1 is 0
            throw gi::InputError(
                {file, int(std::ranges::count(read, '\n')) + 1, int(read.size() - line_start) + 1},
                "this is not JSON", e.byte > text.size() ? "the text ends too early" : "this does not belong here",
                "check the brackets, the commas and the quotes");
        } catch (nlohmann::json::exception const&) { // a number is too large
        }
        throw;
    }
}

} // namespace viewer
