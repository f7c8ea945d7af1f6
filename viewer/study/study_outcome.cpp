#include "viewer/study/study_outcome.h"
#include "gi/core/quantile.h"
#include "viewer/study/study_records.h"

#include <fmt/format.h>

namespace viewer {
namespace {

/// Waiting time between trials, as text; empty if there were no trials.
std::string pause_text(study::SessionOutcome const& s)
{
    if (s.bookkeeping_ms.empty()) return {};
    return fmt::format("; between trials {:.2f} ms (median {:.2f} ms, the disk aside {:.2f} ms)",
                       gi::quantile(s.bookkeeping_ms, 0.99), gi::median(s.bookkeeping_ms),
                       gi::quantile(s.unsynced_ms, 0.99));
}

} // namespace

nlohmann::ordered_json session_json(std::string const& id, study::SessionOutcome const& s)
{
    return {{"participant_id", id},
            {"folder", s.folder.string()},
            {"complete", s.is_complete},
            {"reason", s.reason},
            {"trials", s.trials},
            {"bad_trials", s.bad_trials},
            {"torn_bytes", s.torn_bytes},
            {"plan_remark", s.plan_remark},
            {"bookkeeping_ms",
             {{"median", gi::quantile(s.bookkeeping_ms, 0.5)},
              {"p99", gi::quantile(s.bookkeeping_ms, 0.99)},
              {"p99_without_disk", gi::quantile(s.unsynced_ms, 0.99)}}}};
}

void print_session(std::string const& id, study::SessionOutcome const& s)
{
    if (s.torn_bytes > 0)
        std::fputs(fmt::format("{}: {} bytes of an incomplete line were removed from the journal's end\n", id,
                               s.torn_bytes)
                       .c_str(),
                   stderr);
    if (!s.plan_remark.empty()) std::fputs(fmt::format("{}: {}\n", id, s.plan_remark).c_str(), stderr);
    fmt::print("{}: {} trials, {} bad, {}{}\n", id, s.trials, s.bad_trials, s.is_complete ? "complete" : s.reason,
               pause_text(s));
}

void keep_tables(std::filesystem::path const& dir, std::string const& script_file)
{
    try {
        rebuild_tables(dir, load_records(dir.string(), script_file));
    } catch (std::exception const& e) {
        std::fputs(fmt::format("note: the tables could not be made: {}\n", e.what()).c_str(), stderr);
    }
}

} // namespace viewer
