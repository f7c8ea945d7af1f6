#include "study/run/session_files.h"

#include "study/base/script_error.h"
#include "study/record/durable_file.h"

#include <algorithm>
#include <fmt/format.h>

namespace study {
namespace {

namespace fs = std::filesystem;

bool is_there(fs::path const& path)
{
    std::error_code ignored;
    return fs::exists(fs::symlink_status(path, ignored));
}

/// The outermost missing folder on the way.
fs::path first_missing(fs::path folder)
{
    fs::path missing;
    for (; !folder.empty() && !is_there(folder) && folder != folder.parent_path(); folder = folder.parent_path())
        missing = folder;
    return missing;
}

} // namespace

fs::path session_folder(fs::path const& dir, std::string const& id, int session)
{
    bool const is_plain = !id.empty() && id.size() <= 64 && std::all_of(id.begin(), id.end(), [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    });
    if (!is_plain)
        throw ScriptError("", {}, "'" + id + "' is no participant's id", "it becomes a name of files (BIDS)",
                          "use letters and digits only");
    if (session < 1 || session > 99)
        throw ScriptError("", {}, fmt::format("session {}", session), "there are 1 to 99", "choose one of them");
    return dir / ("sub-" + id) / fmt::format("ses-{:02}", session) / "beh";
}

void check_is_new(std::string const& id, SessionSettings const& settings)
{
    fs::path const folder = session_folder(settings.dir, id, settings.session);
    std::error_code ignored;
    if (!is_there(folder) || (fs::is_directory(folder, ignored) && fs::is_empty(folder, ignored))) return;
    int free = settings.session;
    while (free < 99 && is_there(session_folder(settings.dir, id, free))) ++free;
    throw ScriptError(folder.string(), {},
                      fmt::format("participant {} has a session {} already", id, settings.session),
                      "what was recorded is never overwritten",
                      fmt::format("go on with it by --resume, or begin another one by --session {}", free));
}

SessionFiles open_session(std::string const& id, SessionSettings const& settings)
{
    fs::path const folder = session_folder(settings.dir, id, settings.session), file = folder / "journal.jsonl";
    if (settings.start == SessionStart::go_on && is_there(file)) {
        JournalText found;
        Journal journal = Journal::open(file, found);
        return {folder, std::move(journal), std::move(found), false, {}};
    }
    check_is_new(id, settings);
    fs::path const missing = first_missing(folder);
    make_folder(folder);
    return {folder, Journal::create(file), {}, true, missing};
}

void SessionFiles::discard()
{
    std::error_code ignored;
    for (char const* const name : {"plan.tsv", "journal.jsonl"}) fs::remove(folder / name, ignored);
    if (first_made.empty()) return;
    for (fs::path at = folder; fs::remove(at, ignored) && at != first_made;) at = at.parent_path(); // while empty
}

void check_record(SessionRecord const& record, SessionStarted const& now, fs::path const& file)
{
    auto const* const then =
        record.entries.empty() ? nullptr : std::get_if<SessionStarted>(&record.entries.front());
    auto const refuse = [&](std::string const& problem, std::string const& why, std::string const& suggestion) {
        throw ScriptError(file.string(), {}, problem, why, suggestion);
    };
    if (then == nullptr)
        refuse("the journal does not begin with the start of a session", "", "restore it from a copy");
    if (then->experiment != now.experiment || then->participant_id != now.participant_id ||
        then->participant != now.participant || then->session != now.session)
        refuse(fmt::format("this is the journal of participant {} in session {} of '{}'", then->participant_id,
                           then->session, then->experiment),
               fmt::format("asked for is participant {} in session {} of '{}'", now.participant_id, now.session,
                           now.experiment),
               "check the folder");
    if (then->script_sha256 != now.script_sha256 || then->seed != now.seed)
        refuse("the script is not the one with which the session began",
               fmt::format("its sha256 was {:.12}..., it is {:.12}...", then->script_sha256, now.script_sha256),
               "go on with the script as it was, or begin another session by --session");
    if (then->plan_sha256 != now.plan_sha256)
        refuse("the plan is not the one with which the session began",
               "this version plans the same script otherwise", "go on with version " + then->version);
    if (then->is_simulated != now.is_simulated)
        refuse(then->is_simulated ? "this session was simulated" : "this session is a person's",
               "the two are not mixed", "choose another folder");
}

} // namespace study
