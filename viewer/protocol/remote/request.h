#pragma once
// Requests of the remote protocol: one JSON object per line. All are listed in one table,
// which docs/remote.md shows.

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

namespace viewer {

/// Texts are UTF-8. Numbers are finite. integer: -2^31 to 2^31 - 1. point: [x, y, z]. rotation: quaternion
/// [x, y, z, w], not all 0, normalized by the reader. any: any JSON value.
enum class ArgumentType { text, number, integer, boolean, point, rotation, any };
std::string_view name_of(ArgumentType type);

enum class Presence { required, optional };

struct ArgumentRule {
    char const* name;
    ArgumentType type;
    Presence presence;
    char const* meaning;      ///< with its unit
    char const* choices = ""; ///< allowed words of a text, e.g. "tap press release"; empty = any
};

struct RequestRule {
    char const* name; ///< value of "do"
    char const* meaning;
    char const* result;
    std::vector<ArgumentRule> arguments;
};
std::span<RequestRule const> request_rules();

struct RemoteRequest {
    std::uint64_t token = 0;                             ///< identifies the request when it is answered later
    nlohmann::json id;                                   ///< null, an integer or a text of at most 256 bytes
    std::string what;                                    ///< one of request_rules()
    nlohmann::json arguments = nlohmann::json::object(); ///< checked against the rule

    bool has(char const* name) const { return arguments.contains(name); }
};

/// The request's id if it has a valid one, else null; also works for invalid requests.
nlohmann::json id_of(nlohmann::json const& request);
/// Throws InputError unless the line is a JSON object with at most 32 levels.
nlohmann::json parse_request(std::string_view line);
/// Throws InputError if the request is not in the table, or an argument is missing, unknown or of the wrong type.
RemoteRequest check_request(nlohmann::json const& request);

/// request_rules() as lines for --help: name, arguments (optional ones in brackets), meaning.
std::string requests_as_text();

} // namespace viewer
