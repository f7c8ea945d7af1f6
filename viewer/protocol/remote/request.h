#pragma once
// Requests of the remote protocol: one JSON object per line. What there is, is one table; docs/remote.md shows it.

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

namespace viewer {

/// Texts are UTF-8. Numbers are finite. integer: -2^31 to 2^31 - 1. point: [x, y, z]. rotation: [x, y, z, w], made
/// unit by who reads it, never all 0. any: every JSON value.
enum class ArgumentType { text, number, integer, boolean, point, rotation, any };
std::string_view name_of(ArgumentType type);

enum class Presence { required, optional };

struct ArgumentRule {
    char const* name;
    ArgumentType type;
    Presence presence;
    char const* meaning;      ///< with its unit
    char const* choices = ""; ///< "tap press release": of a text, what it may be; empty = anything
};

struct RequestRule {
    char const* name; ///< of "do"
    char const* meaning;
    char const* result;
    std::vector<ArgumentRule> arguments;
};
std::span<RequestRule const> request_rules();

struct RemoteRequest {
    std::uint64_t token = 0;                             ///< to answer later
    nlohmann::json id;                                   ///< null, an integer or a text of at most 256 bytes
    std::string what;                                    ///< one of request_rules()
    nlohmann::json arguments = nlohmann::json::object(); ///< of the types of its rule, nothing else

    bool has(char const* name) const { return arguments.contains(name); }
};

/// The id of any object that has a valid one, null else; for answers to requests that are wrong.
nlohmann::json id_of(nlohmann::json const& request);
/// Throws InputError on anything that is no JSON object of at most 32 levels.
nlohmann::json parse_request(std::string_view line);
/// Throws InputError on a request that is not in the table, or has arguments that are missing, unknown or of
/// another type.
RemoteRequest check_request(nlohmann::json const& request);

/// request_rules() as lines for --help: name, arguments (optional ones in brackets), meaning.
std::string requests_as_text();

} // namespace viewer
