#include "study/run/session_files.h"

#include "gi/core/durable_file.h"
#include "gi/core/sha256.h"
#include "study/script/script_error.h"

#include <fmt/format.h>
#include <fstream>

namespace study {
namespace {

namespace fs = std::filesystem;

bool is_there(fs::path const& path)
{
    std::error_code ignored;
    return fs::exists(fs::symlink_status(path, ignored));
}

/// The outermost missing folder of a path.
fs::path first_missing(fs::path folder)
{
    fs::path missing;
    for (; !folder.empty() && !is_there(folder) && folder != folder.parent_path(); folder = folder.parent_path())
        missing = folder;
    return missing;
}

/// The first entry of a journal; empty if there is no complete one.
std::optional<SessionStarted> start_of(fs::path const& journal)
{
    std::ifstream in(journal, std::ios::binary);
    if (!in)
        throw ScriptError(journal.string(), {}, "this journal cannot be read", "it may belong to another script",
                          "make it readable");
    std::string line;
    if (!std::getline(in, line)) return {};
    auto const entries = parse_journal(line + "\n", journal.string()).record.entries;
    auto const* const start = entries.empty() ? nullptr : std::get_if<SessionStarted>(&entries.front());
    return start == nullptr ? std::nullopt : std::optional(*start);
}

/// Refuses sessions of two scripts in one folder, which read_dataset could not analyse.
void check_same_script(SessionSettings const& settings)
{
    std::string const hash = gi::sha256(settings.script_text);
    for (fs::path const& journal : find_journals(settings.dir).files)
        if (auto const start = start_of(journal); start && start->script_sha256 != hash)
            throw ScriptError(
                journal.string(), {}, "the folder has sessions of another script",
                fmt::format("this is of '{}' with the sha256 {:.12}..., now it is {:.12}...; sessions of two "
                            "scripts cannot be analysed together",
                            start->experiment, start->script_sha256, hash),
                "record into another folder, or use the original script (it is in code/ of the folder)");
}

} // namespace

void check_is_new(std::string const& id, SessionSettings const& settings)
{
    check_same_script(settings);
    fs::path const folder = session_folder(settings.dir, id, settings.session);
    std::error_code ignored;
    if (!is_there(folder) || (fs::is_directory(folder, ignored) && fs::is_empty(folder, ignored))) return;
    int free = settings.session;
    while (free < 99 && is_there(session_folder(settings.dir, id, free))) ++free;
    throw ScriptError(folder.string(), {},
                      fmt::format("participant {} has a session {} already", id, settings.session),
                      "records are never overwritten",
                      fmt::format("resume it with --resume, or start another one with --session {}", free));
}

SessionFiles open_session(std::string const& id, SessionSettings const& settings)
{
    fs::path const folder = session_folder(settings.dir, id, settings.session), file = folder / "journal.jsonl";
    if (settings.start == SessionStart::go_on && is_there(file)) {
        JournalText found;
        Journal journal = Journal::open(file, found);
        if (found.record.entries.empty()) check_same_script(settings);
        return {folder, std::move(journal), std::move(found), false, {}};
    }
    check_is_new(id, settings);
    fs::path const missing = first_missing(folder);
    gi::make_folder(folder);
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
               fmt::format("requested is participant {} in session {} of '{}'", now.participant_id, now.session,
                           now.experiment),
               "check the folder");
    if (then->script_sha256 != now.script_sha256 || then->seed != now.seed)
        refuse("the script is not the one with which the session began",
               fmt::format("its sha256 was {:.12}..., it is {:.12}...", then->script_sha256, now.script_sha256),
               "use the original script, or start another session with --session");
    if (then->is_simulated != now.is_simulated)
        refuse(then->is_simulated ? "this session was simulated" : "this session is a person's",
               "the two are not mixed", "choose another folder");
}

} // namespace study
