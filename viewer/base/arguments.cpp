#include "viewer/base/arguments.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace viewer {
namespace {

gi::InputError bad(std::string const& option, std::string const& text, std::string const& why,
                   std::string const& suggestion)
{
    return {option + " '" + text + "' is not understood", why, suggestion};
}

} // namespace

std::pair<int, int> parse_size(std::string const& text)
{
    auto const cross = text.find('x');
    auto const number = [&](std::string_view part) {
        auto const v = to_number(part);
        return v && *v >= 1 && *v <= 65536 && *v == std::floor(*v) ? int(*v) : 0;
    };
    if (cross != std::string::npos) {
        int const width = number(std::string_view(text).substr(0, cross));
        int const height = number(std::string_view(text).substr(cross + 1));
        if (width > 0 && height > 0 && std::int64_t(width) * height <= (std::int64_t(1) << 28))
            return {width, height};
    }
    throw bad("--size", text, "two whole numbers from 1 to 65536 and at most 2^28 pixels are needed",
              "write 512x384");
}

gi::dvec3 parse_point(std::string const& option, std::string const& text, std::string const& example)
{
    gi::dvec3 point;
    std::string_view rest = text;
    for (int i = 0; i < 3; ++i) {
        auto const comma = i < 2 ? rest.find(',') : rest.size();
        auto const v = comma == std::string_view::npos ? std::nullopt : to_number(rest.substr(0, comma));
        if (!v) throw bad(option, text, "three numbers with commas between them are needed", "write " + example);
        point[i] = *v;
        rest.remove_prefix(std::min(comma + 1, rest.size()));
    }
    return point;
}

gi::dvec3 parse_color(std::string const& option, std::string const& text)
{
    if (auto const grey = to_number(text); grey && *grey >= 0 && *grey <= 1e9) return gi::dvec3{*grey};
    if (text.find(',') != std::string::npos) {
        gi::dvec3 const c = parse_point(option, text, "0.9,0.5,0.1");
        if (std::min({c.x, c.y, c.z}) >= 0 && std::max({c.x, c.y, c.z}) <= 1e9) return c;
    }
    throw bad(option, text, "one number or three with commas between them, from 0 to 1e9, are needed",
              "write 0.9,0.5,0.1");
}

double parse_duration(std::string const& option, std::string const& text)
{
    struct Unit {
        std::string_view name;
        double seconds;
    };
    for (Unit const unit : {Unit{"ms", 1e-3}, Unit{"min", 60}, Unit{"h", 3600}, Unit{"s", 1}, Unit{"", 1}}) {
        if (!text.ends_with(unit.name)) continue;
        auto const v = to_number(std::string_view(text).substr(0, text.size() - unit.name.size()));
        if (v && *v > 0 && std::isfinite(*v * unit.seconds)) return *v * unit.seconds;
    }
    throw bad(option, text, "a positive duration is needed", "write 500ms, 2s or 3min");
}

std::pair<std::string, double> parse_limit(std::string const& option, std::string const& text,
                                           std::string const& example)
{
    auto const equals = text.find('=');
    if (equals != std::string::npos && equals > 0)
        if (auto const v = to_number(std::string_view(text).substr(equals + 1)))
            return {text.substr(0, equals), *v};
    throw bad(option, text, "a name, '=' and a number are needed", "write " + example);
}

double parse_target(std::string const& option, std::string const& text, std::string const& name)
{
    std::string const example = name + "=0.001";
    auto const [given, value] = parse_limit(option, text, example);
    if (given != name || !(value > 0))
        throw bad(option, text, "only " + name + " with a positive value can be a target", "write " + example);
    return value;
}

std::string check_seed(std::string const& text)
{
    if (text.starts_with('-')) return "'" + text + "' is negative";
    errno = 0;
    std::strtoull(text.c_str(), nullptr, 0); // as CLI11 parses it
    return errno == ERANGE ? "'" + text + "' is larger than 18446744073709551615" : std::string();
}

} // namespace viewer
