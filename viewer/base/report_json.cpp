#include "viewer/base/report_json.h"

#include "gi/kernel/device.h"
#include "gi/kernel/device_work.h"

#include <cstdio>
#include <fmt/format.h>
#include <sys/resource.h>

namespace viewer {
namespace {

nlohmann::ordered_json to_json(gi::DeviceWork const& work)
{
    nlohmann::ordered_json j{{"simulated", gi::is_device_simulated()},
                             {"launches", work.launches},
                             {"waits", work.waits},
                             {"fills", work.fills},
                             {"uploads", work.uploads},
                             {"bytes_to_device", work.bytes_to_device},
                             {"bytes_to_host", work.bytes_to_host},
                             {"bytes_within", work.bytes_within},
                             {"launches_by_kernel", nlohmann::ordered_json::object()}};
    for (auto const& [kernel, n] : gi::launches_by_kernel()) j["launches_by_kernel"][kernel] = n;
    return j;
}

} // namespace

nlohmann::ordered_json to_json(gi::Report const& report)
{
    nlohmann::ordered_json j;
    j["stages_s"] = nlohmann::ordered_json::object();
    for (auto const& [stage, seconds] : report.times()) j["stages_s"][stage] = seconds;
    j["counts"] = nlohmann::ordered_json::object();
    for (auto const& [what, value] : report.counts()) j["counts"][what] = value;
    j["losses"] = nlohmann::ordered_json::object();
    for (auto const& [what, loss] : report.losses())
        j["losses"][what] = {{"count", loss.count}, {"first", loss.first}};
    if (gi::DeviceWork const work = gi::device_work(); work != gi::DeviceWork{}) j["device"] = to_json(work);
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    j["peak_memory_bytes"] = std::uint64_t(usage.ru_maxrss) * 1024;
    return j;
}

void print_losses(gi::Report const& report, std::string const& whose)
{
    for (auto const& [what, loss] : report.losses())
        std::fputs(fmt::format("{}{}{}: {}{}\n", what.starts_with("in doubt: ") ? "" : "lost: ", whose, what,
                               loss.count, loss.first.empty() ? "" : " (first: " + loss.first + ")")
                       .c_str(),
                   stderr);
}

std::string to_text(nlohmann::ordered_json const& json)
{
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

} // namespace viewer
