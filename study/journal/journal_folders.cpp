#include "study/journal/journal_folders.h"

#include "study/script/script_error.h"

#include <algorithm>
#include <fmt/format.h>
#include <system_error>

namespace study {
namespace {

namespace fs = std::filesystem;

/// A missing folder is not an error.
void check_read(fs::path const& path, std::error_code const& failed)
{
    if (!failed || failed == std::errc::no_such_file_or_directory || failed == std::errc::not_a_directory) return;
    throw ScriptError(path.string(), {}, "this cannot be read", failed.message(),
                      "make it readable, or its sessions would be missing");
}

bool is_there(fs::path const& file)
{
    std::error_code failed;
    bool const found = fs::exists(file, failed);
    check_read(file, failed);
    return found;
}

} // namespace

fs::path session_folder(fs::path const& dir, std::string const& id, int session)
{
    bool const is_plain = !id.empty() && id.size() <= 64 && std::all_of(id.begin(), id.end(), [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    });
    if (!is_plain)
        throw ScriptError("", {}, "'" + id + "' is no participant's id", "it is used in file names (BIDS)",
                          "use letters and digits only");
    if (session < 1 || session > 99)
        throw ScriptError("", {}, fmt::format("session {}", session), "there are 1 to 99", "choose one of them");
    return dir / ("sub-" + id) / fmt::format("ses-{:02}", session) / "beh";
}

std::vector<fs::path> names_in(fs::path const& folder, std::string const& prefix)
{
    std::vector<fs::path> found;
    std::error_code failed;
    for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed))
        if (it->path().filename().string().starts_with(prefix)) found.push_back(it->path());
    check_read(folder, failed);
    std::sort(found.begin(), found.end());
    return found;
}

JournalsFound find_journals(fs::path const& dir)
{
    JournalsFound found;
    for (fs::path const& subject : names_in(dir, "sub-")) {
        auto const sessions = names_in(subject, "ses");
        if (sessions.empty()) found.remarks.push_back(subject.string() + ": it has no session and is ignored");
        for (fs::path const& session : sessions)
            if (fs::path const file = session / "beh" / "journal.jsonl"; is_there(file))
                found.files.push_back(file);
            else
                found.remarks.push_back(session.string() +
                                        ": beh/journal.jsonl is missing, this session is ignored");
    }
    return found;
}

} // namespace study
