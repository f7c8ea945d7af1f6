#include "viewer/batch/hyperqueue.h"

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/host_name.h"
#include "gi/core/text.h"
#include "viewer/batch/claim.h"
#include "viewer/batch/journal.h"
#include "viewer/batch/texts.h"
#include "viewer/batch/work.h"
#include "viewer/batch/worker_process.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <poll.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace viewer::batch {
namespace {

namespace fs = std::filesystem;

constexpr int kMostInVain = 3;    ///< jobs one after another in which no task was started
constexpr int kCrashLimit = 1000; ///< workers that HyperQueue may lose with one task
constexpr std::size_t kMostTogether = 16;
constexpr std::size_t kUnknownWorkers = 1024; ///< those of a server that runs already
constexpr int kNoPackage = 4;                 ///< exit code of hyperqueue.py

class HyperQueueRunner {
public:
    HyperQueueRunner(Store const& store, std::string const& id, Batch const& batch,
                     HyperQueueSettings const& settings, gi::StopRequest const& stop)
        : store_(store),
          id_(id),
          batch_(batch),
          settings_(settings),
          stop_(stop),
          view_(batch.name + " on HyperQueue", settings.shows_progress),
          journal_(store.journal()),
          folder_(store.folder() / "work" / fmt::format("{}{}", folder_start(), getpid())),
          has_failed_(batch.tasks.size()),
          lost_(batch.tasks.size())
    {
        out_.counts.total = batch.tasks.size();
        for (std::size_t i = 0; i < batch.tasks.size(); ++i) by_key_.emplace(batch.tasks[i].key, i);
        journal_.read(); // what was before
        remove_old_folders();
    }

    RunOutcome run()
    {
        std::vector<std::size_t> missing = find_missing();
        out_.was_done = out_.counts.done;
        for (int in_vain = 0; !missing.empty() && !stop_.requested();) {
            was_started_.assign(batch_.tasks.size(), false);
            int const code = run_job(missing);
            if (stop_.requested()) break;
            if (code == kNoPackage)
                throw gi::InputError("HyperQueue cannot be used",
                                     "'" + python_program() + "' has no package hyperqueue",
                                     "pip install hyperqueue, and name its interpreter by LIGHTWELL_PYTHON");
            missing = wait_for_publishing(find_missing());
            for (std::size_t const i : missing)
                if (was_started_[i] && ++lost_[i] > kMostLost) has_failed_[i] = true;
            in_vain = std::ranges::count(was_started_, true) > 0 ? 0 : in_vain + 1;
            missing = find_missing();
            if (!missing.empty() && ((code != 0 && !settings_.server_dir.empty()) || in_vain > kMostInVain))
                throw gi::InputError("the server of HyperQueue was lost, or cannot run the tasks",
                                     settings_.server_dir.empty() ? "no task was started in several tries"
                                                                  : "it is that of '" + settings_.server_dir + "'",
                                     "finished tasks are kept: lightwell batch resume '" +
                                         store_.folder().string() + "' goes on");
            out_.lost_workers += !missing.empty();
        }
        out_.is_interrupted = stop_.requested();
        out_.counts.failed = std::size_t(std::ranges::count(has_failed_, true));
        std::error_code none;
        fs::remove_all(folder_, none);
        return out_;
    }

private:
    static std::string folder_start() { return "hyperqueue-" + gi::host_name() + "-"; }

    /// Folders of processes of this machine that were killed.
    void remove_old_folders() const
    {
        std::error_code none;
        for (auto const& entry : fs::directory_iterator(folder_.parent_path(), none)) {
            std::string const name = entry.path().filename().string();
            if (!name.starts_with(folder_start())) continue;
            auto const process = gi::parse_number<int>(std::string_view(name).substr(folder_start().size()));
            if (process && kill(*process, 0) != 0 && errno == ESRCH) fs::remove_all(entry.path(), none);
        }
    }

    /// Tasks without a result, except those that failed for good.
    std::vector<std::size_t> find_missing()
    {
        std::vector<std::size_t> missing;
        out_.counts.done = out_.counts.running = 0;
        for (std::size_t i = 0; i < batch_.tasks.size(); ++i) {
            if (store_.result(batch_.tasks[i].key))
                ++out_.counts.done;
            else if (!has_failed_[i])
                missing.push_back(i);
        }
        return missing;
    }

    /// Tasks that HyperQueue took for done when their results were written, as copies of their processes publish
    /// them. @return those that nobody publishes
    std::vector<std::size_t> wait_for_publishing(std::vector<std::size_t> missing)
    {
        auto const is_published_now = [&](std::size_t i) {
            return Claim(store_.claims(), batch_.tasks[i].key).is_taken_elsewhere();
        };
        while (!stop_.requested() && std::ranges::any_of(missing, is_published_now)) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            follow_journal();
            missing = find_missing();
        }
        return missing;
    }

    /// Tasks that one process runs one after the other, as HyperQueue takes some 30 ms to start one: at first
    /// many, towards the end single ones, so that all workers end together.
    std::vector<std::vector<std::size_t>> share_out(std::vector<std::size_t> const& tasks) const
    {
        std::vector<int> const& cores = settings_.worker_cores; // of an own server
        std::size_t const at_a_time =
            settings_.server_dir.empty() ? std::size_t(std::reduce(cores.begin(), cores.end())) : kUnknownWorkers;
        std::vector<std::vector<std::size_t>> all;
        for (std::size_t k = 0; k < tasks.size();) {
            std::size_t const left = tasks.size() - k;
            std::size_t const most = std::clamp<std::size_t>(left / (4 * at_a_time), 1, kMostTogether);
            std::vector<std::size_t>& together = all.emplace_back();
            auto const fits = [&](std::size_t i) {
                return together.empty() || batch_.tasks[i].resources == batch_.tasks[together.front()].resources;
            };
            for (; k < tasks.size() && together.size() < most && fits(tasks[k]); ++k) together.push_back(tasks[k]);
        }
        return all;
    }

    fs::path write_call(std::vector<std::size_t> const& tasks)
    {
        fs::remove_all(folder_);
        fs::create_directories(folder_ / "server");
        bool const is_own = settings_.server_dir.empty();
        nlohmann::json call{
            {"server_dir", is_own ? (folder_ / "server").string() : settings_.server_dir},
            {"workers", is_own ? settings_.worker_cores : std::vector<int>{}},
            {"name", id_},
            {"crash_limit", kCrashLimit},
            {"command", {settings_.worker.string(), "batch", "work", store_.folder().string(), id_}},
            {"tasks", nlohmann::json::array()}};
        for (std::vector<std::size_t> const& together : share_out(tasks)) {
            Resources const& r = batch_.tasks[together.front()].resources;
            call["tasks"].push_back({together, r.cores, r.gpus, (r.memory_bytes + 1048575) / 1048576});
        }
        gi::write_text(folder_ / "call.json", call.dump());
        return folder_ / "call.json";
    }

    /// @return exit code of the Python process; -1 where it was killed
    int run_job(std::vector<std::size_t> const& tasks)
    {
        auto const bridge =
            WorkerProcess::start_program({python_program(), "-c", kHyperQueueScript, write_call(tasks).string()});
        int status = 0;
        while (::waitpid(bridge.pid, &status, WNOHANG) == 0) {
            if (stop_.requested()) kill(bridge.pid, SIGKILL); // an own server ends with it, and so do the tasks
            pollfd p{bridge.pipe, 0, 0};                      // closed at its end
            ::poll(&p, 1, 200);
            follow_journal();
        }
        ::close(bridge.pipe);
        follow_journal();
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

    void follow_journal()
    {
        for (Event const& event : journal_.read()) {
            auto const found = by_key_.find(event.task);
            if (found == by_key_.end()) continue;
            bool const starts = event.kind == EventKind::started;
            has_failed_[found->second] = event.kind == EventKind::failed; // until it is started again
            if (starts) was_started_[found->second] = true;
            out_.counts.running += starts ? 1 : 0;
            if (!starts && out_.counts.running > 0) --out_.counts.running;
            out_.counts.done += event.kind == EventKind::finished;
        }
        view_.update(out_.counts);
    }

    Store const& store_;
    std::string const& id_;
    Batch const& batch_;
    HyperQueueSettings const& settings_;
    gi::StopRequest const& stop_;
    ProgressView view_;
    TaskJournalReader journal_;
    fs::path folder_; ///< of this process: the call, and an own server's files
    RunOutcome out_;
    std::map<std::string_view, std::size_t> by_key_;
    std::vector<bool> has_failed_;  ///< in this run
    std::vector<bool> was_started_; ///< in this job
    std::vector<int> lost_;         ///< times that a task was started and killed
};

} // namespace

std::string python_program()
{
    if (char const* const stated = std::getenv("LIGHTWELL_PYTHON"); stated != nullptr && *stated != 0)
        return stated;
    std::error_code none;
    fs::path const built = program_folder().parent_path() / "python/bin/python3";
    return fs::exists(built, none) ? built.string() : "python3";
}

RunOutcome run_on_hyperqueue(Store const& store, std::string const& id, Batch const& batch,
                             HyperQueueSettings const& settings, gi::StopRequest const& stop)
{
    return HyperQueueRunner(store, id, batch, settings, stop).run();
}

} // namespace viewer::batch
