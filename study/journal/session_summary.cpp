#include "study/journal/session_summary.h"

#include "gi/core/quantile.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

namespace study {
namespace {

using Json = nlohmann::ordered_json;

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

Json to_json(CalibrationDone const& c)
{
    return {{"frames", c.frames},
            {"nominal_hz", number(c.nominal_hz)},
            {"period_mean_ms", number(c.period_mean_ms)},
            {"period_sd_ms", number(c.period_sd_ms)},
            {"onset_method", c.onset_method},
            {"passed", c.passed},
            {"reason", c.reason}};
}

Json to_json(SessionStarted const& s)
{
    Json about = Json::object();
    for (auto const& [key, value] : s.about) about[key] = value;
    return {{"part", s.part},         {"start", s.utc},         {"gap_s", number(s.gap_s)},
            {"version", s.version},   {"git_hash", s.git_hash}, {"about", about},
            {"calibration", nullptr}, {"end", nullptr},         {"end_reason", "cut off"}};
}

Json percentiles(std::vector<double> values)
{
    if (values.empty()) return nullptr;
    values = gi::sorted_values(std::move(values));
    auto const at = [&](double p) { return number(gi::quantile_of_sorted(values, p)); };
    return {{"count", values.size()}, {"median", at(0.5)}, {"p99", at(0.99)}, {"max", at(1)}};
}

} // namespace

std::string session_summary(SessionRecord const& record)
{
    Json head = Json::object(), parts = Json::array();
    std::vector<double> bookkeeping;
    std::map<std::string, int> bad;
    int trials = 0, repeated = 0, notes = 0;
    bool is_complete = false;
    for (JournalEntry const& entry : record.entries) {
        if (auto const* const s = std::get_if<SessionStarted>(&entry)) {
            if (parts.empty())
                head = {{"experiment", s->experiment},
                        {"participant_id", s->participant_id},
                        {"participant", s->participant},
                        {"session", s->session},
                        {"is_simulated", s->is_simulated},
                        {"script_sha256", s->script_sha256},
                        {"plan_sha256", s->plan_sha256},
                        {"consent_sha256", s->consent_sha256},
                        {"seed", s->seed},
                        {"random_numbers", "PCG32 XSH-RR 64/32"}};
            parts.push_back(to_json(*s));
            is_complete = false;
        } else if (auto const* const t = std::get_if<TrialDone>(&entry)) {
            ++trials;
            repeated += t->attempt > 1;
            if (!t->is_valid) ++bad[t->reason];
            if (t->bookkeeping_ms > 0) bookkeeping.push_back(t->bookkeeping_ms);
        } else if (std::holds_alternative<NoteTaken>(entry)) {
            ++notes;
        }
        if (parts.empty()) continue;
        if (auto const* const c = std::get_if<CalibrationDone>(&entry)) parts.back()["calibration"] = to_json(*c);
        if (auto const* const e = std::get_if<SessionEnded>(&entry)) {
            parts.back()["end"] = e->utc;
            parts.back()["end_reason"] = e->reason;
            is_complete = e->is_complete;
        }
    }
    head["complete"] = is_complete;
    head["trials"] = trials;
    head["trials_repeated"] = repeated;
    head["trials_not_valid"] = bad;
    head["notes"] = notes;
    head["bookkeeping_ms"] = percentiles(std::move(bookkeeping));
    head["parts"] = parts;
    return head.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace study
