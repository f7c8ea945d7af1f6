#include "viewer/batch/work.h"

#include "gi/core/error.h"
#include "viewer/batch/child.h"
#include "viewer/batch/claim.h"
#include "viewer/batch/file_hash.h"
#include "viewer/batch/journal.h"
#include "viewer/batch/resume.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>
#include <thread>

namespace viewer::batch {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kKeyLength = 64; ///< hexadecimal SHA-256

struct Attempt {
    ChildEnd end;
    std::string why; ///< it failed; empty = it did not
    bool may_pass = true;
};

/// How an input differs from the one that was planned; empty = it does not.
std::string change_of(InputFile const& file)
{
    std::error_code failed;
    if (fs::file_size(file.path, failed) == file.bytes && !failed && changed_ns(file.path) == file.changed_ns)
        return {};
    if (failed) return "the input '" + file.path.string() + "' cannot be read: " + failed.message();
    return file_sha256(file.path) == file.sha256
               ? ""
               : "the input '" + file.path.string() +
                     "' has changed since the batch was planned: call lightwell batch "
                     "with the manifest again";
}

bool has_resumable(fs::path const& folder, Task const& task)
{
    std::error_code none;
    return std::ranges::any_of(resumable_files(task),
                               [&](std::string const& name) { return fs::exists(folder / name, none); });
}

class Run {
public:
    Run(Store const& store, Batch const& batch, Task const& task, WorkSettings const& settings,
        gi::StopRequest const& stop)
        : store_(store), batch_(batch), task_(task), settings_(settings), stop_(stop), journal_(store.journal())
    {
    }

    WorkEnd run()
    {
        for (int const i : task_.inputs)
            if (std::string const why = change_of(batch_.files[std::size_t(i)]); !why.empty()) {
                Event event;
                event.kind = EventKind::failed;
                event.why = why;
                tell(event);
                return WorkEnd::failed;
            }
        for (int attempt = 1;; ++attempt) {
            Event event; // started
            event.attempt = attempt;
            tell(event);
            Attempt const a = try_once();
            event.seconds = a.end.seconds;
            event.why = a.why;
            event.messages = a.end.messages;
            if (a.end.reason == ChildEnd::Reason::interrupted) {
                event.kind = EventKind::interrupted;
                tell(event);
                return WorkEnd::interrupted;
            }
            if (a.why.empty()) return publish(a, event);
            event.kind = EventKind::failed;
            tell(event);
            if (!a.may_pass || attempt > task_.retries) return WorkEnd::failed;
        }
    }

private:
    enum class Begin : std::uint8_t { from_what_is_left, anew };

    fs::path folder() const { return store_.work(task_.key); }

    WorkEnd publish(Attempt const& a, Event event)
    {
        Result result;
        result.task = task_.key;
        result.seconds = a.end.seconds;
        result.memory_bytes = a.end.memory_bytes;
        result.attempts = event.attempt;
        result.messages = std::exchange(event.messages, {}); // they need not be in the journal too
        for (std::string const& name : task_.outputs) result.outputs.push_back({name, {}, 0});
        event.kind = EventKind::finished;
        try {
            store_.prepare(result);
            if (settings_.prepared && settings_.prepared() == Publish::elsewhere) return WorkEnd::passed_on;
            store_.publish(task_.key);
        } catch (gi::InputError const& e) {
            store_.withdraw(result); // a task reported as failed is not published later
            event.kind = EventKind::failed;
            event.why = e.what();
        }
        tell(event);
        return event.kind == EventKind::finished ? WorkEnd::done : WorkEnd::failed;
    }

    void tell(Event event)
    {
        event.task = task_.key;
        journal_.append(std::move(event));
    }

    /// Makes a folder with links to the inputs, folders for outputs, and what an
    /// interrupted attempt left to resume from.
    /// @return whether there is something of that
    bool make_folder(Begin begin)
    {
        bool const goes_on = begin == Begin::from_what_is_left && has_resumable(folder(), task_);
        if (!fs::create_directories(folder())) { // one that a killed process left
            if (goes_on) {
                remove_other_files();
            } else {
                fs::remove_all(folder());
                fs::create_directory(folder());
            }
        }
        for (int const i : task_.inputs) {
            InputFile const& file = batch_.files[std::size_t(i)];
            if (fs::path(file.name).is_absolute()) continue;
            fs::create_directories((folder() / file.name).parent_path());
            fs::create_symlink(file.path, folder() / file.name);
        }
        for (std::string const& output : task_.outputs) // the folder of a folder: the program makes that itself
            fs::create_directories((folder() / output.substr(0, output.find_last_not_of('/') + 1)).parent_path());
        return goes_on;
    }

    void remove_other_files()
    {
        std::vector<std::string> const kept = resumable_files(task_);
        std::vector<fs::path> others;
        for (auto const& entry : fs::recursive_directory_iterator(folder()))
            if (!fs::is_directory(entry.symlink_status()) &&
                std::ranges::count(kept, entry.path().lexically_relative(folder()).string()) == 0)
                others.push_back(entry.path());
        for (fs::path const& file : others) fs::remove(file);
    }

    Attempt try_once(Begin begin = Begin::from_what_is_left)
    {
        bool goes_on = false;
        try {
            goes_on = make_folder(begin);
        } catch (fs::filesystem_error const& e) {
            throw gi::InputError("cannot make the folder of a task '" + folder().string() + "'",
                                 e.code().message(), "free some space, or make the store writable");
        }
        std::vector<std::string> command = task_.command;
        if (goes_on) command.emplace_back("--resume");
        ChildCall const call{.program = settings_.program,
                             .arguments = command,
                             .folder = folder(),
                             .standard_output = task_.standard_output.empty() ? fs::path("/dev/null")
                                                                              : folder() / task_.standard_output,
                             .limit_s = task_.limit_s,
                             .memory_bytes = task_.resources.memory_bytes};
        Attempt a;
        a.end = run_child(call, stop_);
        if (goes_on && a.end.reason == ChildEnd::Reason::exited && a.end.code != 0 && a.end.code < 128) {
            Attempt anew = try_once(Begin::anew);
            anew.end.messages.insert(0, "what was kept is of no use (" + text_of(a.end, call) + "); begun anew\n");
            return anew;
        }
        if (!a.end.is_good()) {
            a.why = text_of(a.end, call);
            a.may_pass = a.end.reason != ChildEnd::Reason::exited || a.end.code != 2;
            return a;
        }
        for (std::string const& output : task_.outputs) {
            fs::path const file = folder() / output;
            std::error_code none;
            bool const is_there = output.ends_with('/') ? fs::is_directory(file, none)
                                                        : fs::is_regular_file(fs::symlink_status(file, none));
            if (is_there) continue;
            a.why = "it made no '" + output + "'";
            a.may_pass = false;
            break;
        }
        return a;
    }

    Store const& store_;
    Batch const& batch_;
    Task const& task_;
    WorkSettings const& settings_;
    gi::StopRequest const& stop_;
    TaskJournal journal_;
};

void tell_failure(Store const& store, std::string const& key, std::string const& why)
{
    Event event;
    event.kind = EventKind::failed;
    event.task = key;
    event.why = why;
    TaskJournal(store.journal()).append(event);
}

bool is_key(std::string const& name)
{
    return name.size() == kKeyLength && name.find_first_not_of("0123456789abcdef") == name.npos;
}

/// Publishes results that were prepared before their process was killed, and reports its end to the journal.
bool recover(Store const& store, std::string const& key)
{
    auto const result = store.recover(key);
    if (!result) return false;
    Event event;
    event.kind = EventKind::finished;
    event.task = key;
    event.attempt = result->attempts;
    event.seconds = result->seconds;
    TaskJournal(store.journal()).append(event);
    return true;
}

/// @return why it could not be published
std::string settle(Store const& store, std::string const& key)
try {
    Claim claim(store.claims(), key);
    if (!claim.take()) return {};
    std::error_code none;
    bool const is_done = store.result(key) || recover(store, key);
    if (is_done) fs::remove_all(store.work(key), none);
    return {};
} catch (gi::InputError const& e) {
    return e.what();
}

} // namespace

WorkEnd work_on(Store const& store, Batch const& batch, Task const& task, WorkSettings const& settings,
                gi::StopRequest const& stop)
{
    Claim claim(store.claims(), task.key);
    while (!claim.take()) {
        if (settings.if_taken == IfTaken::leave) return WorkEnd::taken;
        if (stop.requested()) return WorkEnd::interrupted;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    WorkEnd end = WorkEnd::failed;
    try {
        bool const is_done = store.result(task.key) || recover(store, task.key);
        end = is_done ? WorkEnd::was_done : Run(store, batch, task, settings, stop).run();
    } catch (gi::InputError const& e) {
        tell_failure(store, task.key, e.what());
        throw;
    }
    if (end == WorkEnd::passed_on) return end;
    std::error_code none;
    if ((end == WorkEnd::interrupted || end == WorkEnd::failed) && has_resumable(store.work(task.key), task))
        return end;
    if (!fs::remove(store.work(task.key), none)) fs::remove_all(store.work(task.key), none);
    return end;
}

int exit_code_of(WorkEnd end)
{
    switch (end) {
    case WorkEnd::done:
    case WorkEnd::was_done:
    case WorkEnd::passed_on:
        return kWorkDone;
    case WorkEnd::taken:
        return kWorkTaken;
    case WorkEnd::interrupted:
        return kWorkInterrupted;
    case WorkEnd::failed:
        break;
    }
    return kWorkFailed;
}

std::vector<std::string> settle_leftovers(Store const& store)
{
    std::vector<std::string> failures;
    std::error_code none;
    std::set<std::string> keys;
    for (auto const& entry : fs::directory_iterator(store.work("").parent_path(), none))
        if (std::string const key = entry.path().stem().string(); is_key(key)) keys.insert(key);
    for (std::string const& key : keys)
        if (std::string const why = settle(store, key); !why.empty()) failures.push_back(why);
    return failures;
}

} // namespace viewer::batch
