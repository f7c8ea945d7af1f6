#include "viewer/cli/ar/ar_outcome.h"

#include "gi/core/error.h"
#include "gi/core/text.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace viewer {

void declare_require_found(CLI::App& command, std::string& text)
{
    command.add_option(
        "--require-found", text,
        "Exit code 1 if fewer frames have a trusted camera pose, e.g. 90% (default: 1 if none has, or "
        "most frames are refused)");
}

std::optional<double> parse_share(std::string const& option, std::string const& text)
{
    if (text.empty()) return std::nullopt;
    bool const in_percent = text.back() == '%';
    auto const number = gi::parse_finite(std::string_view(text).substr(0, text.size() - in_percent));
    double const share = number.value_or(-1) / (in_percent ? 100 : 1);
    if (!(share >= 0 && share <= 1))
        throw gi::InputError(option + " '" + text + "'", "it is a share of the frames, 0% to 100% or 0 to 1",
                             "write 90%");
    return share;
}

std::optional<std::string> most_refused(std::uint64_t used, std::uint64_t refused, std::string const& what)
{
    if (refused <= used) return std::nullopt;
    return fmt::format(
        "{} of {} {} were refused (they could not be read, or differ from the calibration) check them "
        "one by one; reasons are above",
        refused, used + refused, what);
}

std::optional<std::string> shortfall(FrameTally const& t, std::optional<double> required)
{
    std::uint64_t const all = t.looked_at + t.refused;
    std::string const refused = t.refused > 0 ? fmt::format(", {} were refused", t.refused) : "";
    std::string const help = (t.lost_by.empty() ? "" : "mostly: " + t.lost_by + "; ") +
                             (t.hint.empty() ? "" : t.hint + "; ") +
                             std::string("check markers, light, calibration and pose.least_confidence");
    if (required && double(t.found) < *required * double(all))
        return fmt::format("the camera was found in {} of {} frames{} ({:g} % are required) {}", t.found, all,
                           refused, 100 * *required, help);
    if (required) return std::nullopt;
    if (t.found == 0 && t.looked_at > 0)
        return fmt::format("the camera was found in none of {} frames{} (nothing virtual is in them) {}", all,
                           refused, help);
    return most_refused(t.looked_at, t.refused, "frames");
}

int exit_code_of(std::optional<std::string> const& message)
{
    if (!message) return 0;
    std::fputs(fmt::format("lightwell: {}\n", *message).c_str(), stderr);
    return 1;
}

} // namespace viewer
