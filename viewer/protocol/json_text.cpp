#include "viewer/protocol/json_text.h"

#include "viewer/protocol/bytes.h"

#include <fmt/format.h>

namespace viewer {

nlohmann::json parse_json(std::string_view text, int most_levels)
{
    auto const limit = [&](int depth, nlohmann::json::parse_event_t, nlohmann::json const&) {
        if (depth > most_levels)
            throw BadBytes(fmt::format("its values are nested deeper than {} levels", most_levels));
        return true;
    };
    try {
        return nlohmann::json::parse(text, limit);
    } catch (nlohmann::json::exception const& e) {
        throw BadBytes(e.what());
    }
}

std::string json_line(nlohmann::ordered_json const& value)
{
    return value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

} // namespace viewer
