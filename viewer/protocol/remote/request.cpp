#include "viewer/protocol/remote/request.h"

#include "gi/core/error.h"
#include "viewer/protocol/bytes.h"
#include "viewer/protocol/json_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <sstream>

namespace viewer {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 7> kTypeNames{"text",  "number",   "integer", "boolean",
                                                     "point", "rotation", "any"};
constexpr std::size_t kMostIdBytes = 256;

/// A value as JSON, shortened for a message.
std::string shown(json const& value)
{
    std::string const text = json_line(value);
    return text.size() <= 60 ? text : text.substr(0, 57) + "...";
}

bool is_id(json const& id)
{
    return id.is_null() || id.is_number_integer() ||
           (id.is_string() && id.get_ref<std::string const&>().size() <= kMostIdBytes);
}

bool is_number(json const& v) { return v.is_number() && std::isfinite(v.get<double>()); }

bool are_numbers(json const& v, std::size_t count)
{
    return v.is_array() && v.size() == count && std::all_of(v.begin(), v.end(), is_number);
}

bool fits(json const& v, ArgumentType type)
{
    using Int = std::numeric_limits<std::int32_t>;
    switch (type) {
    case ArgumentType::text:
        return v.is_string();
    case ArgumentType::number:
        return is_number(v);
    case ArgumentType::integer:
        return v.is_number_integer() && v.get<double>() >= Int::min() && v.get<double>() <= Int::max();
    case ArgumentType::boolean:
        return v.is_boolean();
    case ArgumentType::point:
        return are_numbers(v, 3);
    case ArgumentType::rotation:
        return are_numbers(v, 4) && std::any_of(v.begin(), v.end(), [](json const& q) { return q != 0; });
    case ArgumentType::any:
        return true;
    }
    return false;
}

std::vector<std::string> words(std::string const& text)
{
    std::istringstream in(text);
    std::vector<std::string> out;
    for (std::string word; in >> word;) out.push_back(word);
    return out;
}

RequestRule const& rule_of(json const& request)
{
    std::string known;
    for (RequestRule const& r : request_rules()) known += (known.empty() ? "" : ", ") + std::string(r.name);
    if (!request.contains("do"))
        throw gi::InputError("the request has no \"do\"", "\"do\" names the request", "give one of: " + known);
    for (RequestRule const& r : request_rules())
        if (request["do"] == r.name) return r;
    throw gi::InputError("\"do\": " + shown(request["do"]) + " is no request", "it is not in the table",
                         "give one of: " + known);
}

void check_argument(RequestRule const& r, std::string const& name, json const& value)
{
    std::string known;
    for (ArgumentRule const& a : r.arguments) {
        known += (known.empty() ? "" : ", ") + std::string(a.name);
        if (name != a.name) continue;
        if (!fits(value, a.type))
            throw gi::InputError(fmt::format("\"{}\": {} does not fit \"{}\"", name, shown(value), r.name),
                                 fmt::format("it must be of the type {}", name_of(a.type)), "see docs/remote.md");
        auto const choices = words(a.choices);
        if (!choices.empty() &&
            std::find(choices.begin(), choices.end(), value.get<std::string>()) == choices.end())
            throw gi::InputError(fmt::format("\"{}\": {} does not fit \"{}\"", name, shown(value), r.name),
                                 "it is not one of the choices", std::string("give one of: ") + a.choices);
        return;
    }
    throw gi::InputError(fmt::format("\"{}\" has no argument {}", r.name, shown(name)), "its name is unknown",
                         known.empty() ? "leave it out" : "its arguments are: " + known);
}

} // namespace

std::string_view name_of(ArgumentType type) { return kTypeNames.at(std::size_t(type)); }

json id_of(json const& request)
{
    if (!request.is_object() || !request.contains("id") || !is_id(request["id"])) return nullptr;
    return request["id"];
}

json parse_request(std::string_view line)
{
    try {
        json request = parse_json(line);
        if (!request.is_object()) throw BadBytes("it is no object");
        return request;
    } catch (BadBytes const& e) {
        throw gi::InputError("the line is no request", e.what(), "send one JSON object per line");
    }
}

RemoteRequest check_request(json const& request)
{
    if (request.contains("id") && !is_id(request["id"]))
        throw gi::InputError("\"id\": " + shown(request["id"]) + " cannot be echoed",
                             "an id is an integer or a text of at most 256 bytes", "number the requests");
    RequestRule const& rule = rule_of(request);
    RemoteRequest r;
    r.id = id_of(request);
    r.what = rule.name;
    for (auto const& [name, value] : request.items()) {
        if (name == "id" || name == "do") continue;
        check_argument(rule, name, value);
        r.arguments[name] = value;
    }
    for (ArgumentRule const& a : rule.arguments)
        if (a.presence == Presence::required && !r.has(a.name))
            throw gi::InputError(fmt::format("\"{}\" has no \"{}\"", rule.name, a.name),
                                 std::string("it needs one: ") + a.meaning, "add it");
    return r;
}

} // namespace viewer
