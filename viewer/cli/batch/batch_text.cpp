#include "viewer/cli/batch/batch_text.h"

#include "gi/core/progress.h"
#include "gi/core/text.h"
#include "viewer/base/report_json.h"

#include <algorithm>
#include <fmt/format.h>

namespace viewer {
namespace {

using Json = nlohmann::ordered_json;
using batch::TaskState;

constexpr std::size_t kMostFailures = 10; ///< shown on the terminal

char const* name_of(TaskState state)
{
    constexpr std::array<char const*, 4> kNames{"waiting", "running", "done", "failed"};
    return kNames[std::size_t(state)];
}

void print(Json const& j) { std::fputs(to_text(j).c_str(), stdout); }

struct GroupCounts {
    std::string name;
    int tasks = 0, done = 0;
};

std::vector<GroupCounts> groups_of(batch::Batch const& b, batch::BatchState const& state)
{
    std::vector<GroupCounts> groups;
    for (std::size_t i = 0; i < b.tasks.size(); ++i) {
        auto at = std::ranges::find(groups, b.tasks[i].group, &GroupCounts::name);
        if (at == groups.end()) at = groups.insert(at, {b.tasks[i].group});
        ++at->tasks;
        at->done += state.tasks[i].state == TaskState::done;
    }
    return groups;
}

Json json_of(batch::Batch const& b, batch::BatchState const& s)
{
    Json j{{"tasks", b.tasks.size()},
           {"done", s.done},
           {"running", s.running},
           {"failed", s.failed},
           {"waiting", s.waiting},
           {"repeated_attempts", s.repeated},
           {"seconds", s.seconds},
           {"seconds_left", seconds_left(b, s)},
           {"damaged_journal_lines", s.damaged_lines},
           {"hosts", s.hosts},
           {"groups", Json::array()},
           {"failures", Json::array()}};
    for (GroupCounts const& g : groups_of(b, s))
        j["groups"].push_back({{"name", g.name}, {"tasks", g.tasks}, {"done", g.done}});
    for (std::size_t i = 0; i < b.tasks.size(); ++i)
        if (s.tasks[i].state == TaskState::failed)
            j["failures"].push_back({{"task", title_of(b.tasks[i])},
                                     {"index", i},
                                     {"attempts", s.tasks[i].starts},
                                     {"host", s.tasks[i].last.host},
                                     {"why", s.tasks[i].last.why},
                                     {"messages", s.tasks[i].last.messages}});
    return j;
}

/// The last line that is not empty.
std::string last_line(std::string const& text)
{
    std::string_view rest = gi::trimmed(text);
    while (rest.ends_with('\n')) rest = gi::trimmed(rest.substr(0, rest.size() - 1));
    return std::string(rest.substr(rest.rfind('\n') == rest.npos ? 0 : rest.rfind('\n') + 1));
}

void print_failures(batch::Batch const& b, batch::BatchState const& s, std::FILE* to)
{
    std::size_t told = 0;
    for (std::size_t i = 0; i < b.tasks.size(); ++i) {
        batch::TaskView const& t = s.tasks[i];
        if (t.state != TaskState::failed || ++told > kMostFailures) continue;
        std::string const said = last_line(t.last.messages);
        fmt::print(to, "failed: {} (task {}, attempt {} on {}): {}{}\n", title_of(b.tasks[i]), i, t.last.attempt,
                   t.last.host, t.last.why, said.empty() ? "" : "; it said: " + said);
    }
    if (told > kMostFailures) fmt::print(to, "and {} more: batch status --json has all\n", told - kMostFailures);
}

/// Losses that finished tasks reported themselves, by lines "lost: ...".
int tasks_with_losses(batch::BatchState const& s)
{
    return int(std::ranges::count_if(s.tasks, [](batch::TaskView const& t) {
        return t.result && t.result->messages.find("lost: ") != std::string::npos;
    }));
}

} // namespace

void print_plan(batch::Batch const& b, batch::BatchState const& s, int cores, bool as_json)
{
    if (as_json) {
        Json j = json_of(b, s);
        j["files"] = b.files.size();
        for (std::size_t i = 0; i < b.tasks.size(); ++i)
            j["list"].push_back({{"task", title_of(b.tasks[i])},
                                 {"key", b.tasks[i].key},
                                 {"state", name_of(s.tasks[i].state)},
                                 {"command", b.tasks[i].command},
                                 {"outputs", b.tasks[i].outputs}});
        return print(j);
    }
    fmt::print("{}: {} tasks, {} done, {} input files\n", b.name, b.tasks.size(), s.done, b.files.size());
    for (GroupCounts const& g : groups_of(b, s)) {
        auto const first = std::ranges::find(b.tasks, g.name, &batch::Task::group);
        fmt::print("  {}: {} tasks, {} done; the first: lightwell {}\n", g.name, g.tasks, g.done,
                   fmt::join(first->command, " "));
    }
    if (double const left = seconds_left(b, s); left > 0)
        fmt::print("left: about {} of one core, {} here\n", gi::text_of_seconds(left),
                   gi::text_of_seconds(left / cores));
}

void print_run(batch::Store const& store, std::string const& id, batch::Batch const& b,
               batch::RunOutcome const& outcome, bool as_json)
{
    batch::BatchState const s = state_of(store, b);
    if (as_json) {
        Json j{{"batch", id},
               {"store", store.folder().string()},
               {"interrupted", outcome.is_interrupted},
               {"done_before", outcome.was_done},
               {"lost_workers", outcome.lost_workers}};
        j.update(json_of(b, s));
        print(j);
    } else {
        fmt::print("{}: {} of {} tasks done{}{}\n", store.folder().string(), s.done, b.tasks.size(),
                   outcome.was_done > 0 ? fmt::format(", {} of them before", outcome.was_done) : "",
                   s.failed > 0 ? fmt::format(", {} failed", s.failed) : "");
        std::fflush(stdout);
    }
    if (outcome.lost_workers > 0)
        fmt::print(stderr, "{} times a process was killed and its task begun again\n", outcome.lost_workers);
    print_failures(b, s, stderr);
    if (int const n = tasks_with_losses(s); n > 0)
        fmt::print(stderr, "{} tasks report losses: lightwell batch status {} --messages\n", n,
                   store.folder().string());
    if (outcome.is_interrupted)
        fmt::print(
            stderr,
            "interrupted: finished tasks are kept; the same command, or lightwell batch resume {}, goes on\n",
            store.folder().string());
}

void print_states(batch::Store const& store, std::vector<std::string> const& ids, bool with_messages, bool as_json)
{
    Json all{{"store", store.folder().string()}, {"batches", Json::array()}};
    for (std::string const& id : ids) {
        batch::Batch const b = store.batch(id);
        batch::BatchState const s = state_of(store, b);
        if (as_json) {
            Json j{{"batch", id}};
            j.update(json_of(b, s));
            if (with_messages)
                for (std::size_t i = 0; i < b.tasks.size(); ++i)
                    if (s.tasks[i].result && !s.tasks[i].result->messages.empty())
                        j["messages"][title_of(b.tasks[i])] = s.tasks[i].result->messages;
            all["batches"].push_back(std::move(j));
            continue;
        }
        fmt::print("{}: {} tasks, {} done, {} running, {} failed, {} waiting\n", id, b.tasks.size(), s.done,
                   s.running, s.failed, s.waiting);
        for (GroupCounts const& g : groups_of(b, s)) fmt::print("  {}: {} of {}\n", g.name, g.done, g.tasks);
        for (auto const& [host, n] : s.hosts) fmt::print("  {} on {}\n", n, host);
        if (s.done > 0) fmt::print("  {:.3g} s per task", s.seconds / s.done);
        if (double const left = seconds_left(b, s); left > 0)
            fmt::print(", about {} left on one core", gi::text_of_seconds(left));
        if (s.done > 0) fmt::print("\n");
        if (s.repeated > 0) fmt::print("  {} attempts were repeated\n", s.repeated);
        if (s.damaged_lines > 0) fmt::print("  {} damaged lines in the journal\n", s.damaged_lines);
        print_failures(b, s, stdout);
        if (!with_messages) continue;
        for (std::size_t i = 0; i < b.tasks.size(); ++i)
            if (s.tasks[i].result && !s.tasks[i].result->messages.empty())
                fmt::print("{}:\n{}\n", title_of(b.tasks[i]), s.tasks[i].result->messages);
    }
    if (as_json) print(all);
}

void print_gathered(batch::Gathered const& g, batch::Batch const& b, std::string const& folder, bool as_json)
{
    if (as_json)
        print({{"folder", folder},
               {"files", g.files},
               {"tasks", g.tasks},
               {"missing", g.missing},
               {"merged", g.merged},
               {"damaged", g.damaged}});
    else
        fmt::print("{}: {} files of {} tasks{}\n", folder, g.files, g.tasks,
                   g.merged.empty() ? "" : fmt::format("; joined: {}", fmt::join(g.merged, ", ")));
    std::fflush(stdout);
    for (std::string const& what : g.damaged)
        fmt::print(stderr, "lost: damaged in the store, {} (lightwell batch resume makes it again)\n", what);
    if (g.missing > 0) fmt::print(stderr, "{} of {} tasks have no outputs yet\n", g.missing, b.tasks.size());
}

} // namespace viewer
