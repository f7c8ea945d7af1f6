#include "study/tables/dataset.h"

#include "gi/core/file.h"
#include "gi/core/sha256.h"
#include "study/journal/journal_file.h"
#include "study/journal/journal_folders.h"
#include "study/script/script_file.h"

#include <fmt/format.h>
#include <map>

namespace study {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> journals(fs::path const& dir, std::vector<std::string>& remarks)
{
    JournalsFound found = find_journals(dir);
    if (found.files.empty())
        throw ScriptError(dir.string(), {}, "no session is there",
                          "sessions are in sub-ID/ses-01/beh/journal.jsonl below that folder",
                          "name the folder that was given to `study run` or `study simulate`");
    remarks = std::move(found.remarks);
    return std::move(found.files);
}

struct Text {
    std::string file, text;
};

Text script_of(fs::path const& dir, fs::path const& named, std::string const& hash)
{
    if (!named.empty()) return {named.string(), gi::read_text(named)};
    for (fs::path const& file : names_in(dir / "code", ""))
        if (file.extension() == ".yaml")
            if (std::string text = gi::read_text(file); gi::sha256(text) == hash) return {file.string(), text};
    throw ScriptError((dir / "code").string(), {}, "the script of the sessions is not there",
                      "trials cannot be interpreted without it", "name it with --script");
}

SessionStarted const& first_of(SessionRecord const& record, fs::path const& file)
{
    auto const* start = record.entries.empty() ? nullptr : std::get_if<SessionStarted>(&record.entries.front());
    if (start == nullptr)
        throw ScriptError(file.string(), {}, "the journal does not begin with the start of a session",
                          "the following entries cannot be interpreted", "move it away, it has no finished trial");
    return *start;
}

/// A copy of a session in another folder would count twice.
void check_place(fs::path const& dir, fs::path const& file, SessionStarted const& start)
{
    fs::path const right = session_folder(dir, start.participant_id, start.session) / "journal.jsonl";
    if (file != right)
        throw ScriptError(file.string(), {},
                          fmt::format("this is the journal of participant {} in session {}", start.participant_id,
                                      start.session),
                          "its folder is that of another: a copy would count twice",
                          "move it to " + right.parent_path().string() + ", or out of the data set");
}

} // namespace

fs::path kept_script(fs::path const& dir, Script const& script) { return dir / "code" / (script.id + ".yaml"); }

Dataset read_dataset(fs::path const& dir, fs::path const& script)
{
    Dataset d;
    std::string hash;
    std::map<PlanSource, std::vector<std::string>> plans; ///< remarks about them
    for (fs::path const& file : journals(dir, d.remarks)) {
        JournalText journal = read_journal(file);
        if (journal.torn_bytes > 0)
            d.remarks.push_back(
                fmt::format("{}: {} bytes of an incomplete line are ignored", file.string(), journal.torn_bytes));
        if (journal.record.entries.empty()) {
            d.remarks.push_back(fmt::format("{}: nothing has happened in this session yet", file.string()));
            continue;
        }
        SessionStarted const& start = first_of(journal.record, file);
        check_place(dir, file, start);
        if (hash.empty()) {
            Text const text = script_of(dir, script, start.script_sha256);
            d.script = parse_script(text.text, text.file);
            d.script_text = text.text;
            hash = gi::sha256(text.text);
            d.inputs.insert(d.inputs.begin(), {text.file, hash});
        }
        if (start.script_sha256 != hash)
            throw ScriptError(file.string(), {}, "the session was recorded with another script",
                              fmt::format("'{}' has another hash", d.script.file),
                              "name the original script, byte for byte, with --script");
        if (start.participant < 1 || start.participant > d.script.participants.count)
            throw ScriptError(file.string(), {}, fmt::format("participant {}", start.participant),
                              "the script has no such participant", "name the right script with --script");
        SessionPlan planned = recorded_plan(d.script, journal.record, file.parent_path());
        if (!planned.remark.empty())
            plans[planned.source].push_back(file.parent_path().parent_path().lexically_relative(dir).string() +
                                            ": " + planned.remark);
        d.inputs.push_back({file.string(), gi::sha256(gi::read_text(file))});
        d.sessions.push_back({std::move(planned.plan), std::move(journal.record), {}, planned.source});
        fill_chosen(d.script, d.sessions.back());
    }
    if (d.sessions.empty())
        throw ScriptError(dir.string(), {}, "no session has started", "all journals are empty", "run one first");
    for (auto const& [source, remarks] : plans)
        d.remarks.push_back(fmt::format("plans of {} of {} sessions; {}{}", remarks.size(), d.sessions.size(),
                                        remarks.front(), remarks.size() > 1 ? "; the others likewise" : ""));
    return d;
}

} // namespace study
