#include "viewer/batch/local_runner.h"

#include "gi/core/error.h"
#include "viewer/batch/claim.h"
#include "viewer/batch/work.h"
#include "viewer/batch/worker_process.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <deque>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace viewer::batch {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kLookElsewhere = 300ms; ///< between looks at tasks that other processes run
constexpr auto kTimeToEnd = 1s;        ///< for workers to end their tasks

class Runner {
public:
    Runner(Store const& store, Batch const& batch, LocalSettings const& settings, gi::StopRequest const& stop)
        : store_(store),
          batch_(batch),
          settings_(settings),
          stop_(stop),
          allocator_(settings.machine),
          view_(batch.name, settings.shows_progress),
          lost_(batch.tasks.size())
    {
        out_.counts.total = batch.tasks.size();
    }

    RunOutcome run()
    {
        list_tasks();
        while (!stop_.requested() && (!pending_.empty() || !running_.empty() || !elsewhere_.empty())) {
            start_tasks();
            look_elsewhere();
            wait_a_moment();
            end_workers();
            show();
        }
        if (stop_.requested()) interrupt();
        return out_;
    }

private:
    struct Running {
        WorkerProcess worker;
        std::size_t task = 0;
        Share share;
        bool is_prepared = false;
        bool is_ending = false; ///< its end of the pipe is closed: it will soon be gone
    };

    void list_tasks()
    {
        std::size_t const n = batch_.tasks.size();
        std::size_t const first = n * std::size_t(settings_.rank) / std::size_t(settings_.ranks);
        for (std::size_t k = 0; k < n; ++k) {
            std::size_t const i = (first + k) % n;
            Task const& task = batch_.tasks[i];
            if (store_.result(task.key)) {
                ++out_.counts.done;
                continue;
            }
            if (std::string const why = allocator_.refusal(task.resources); !why.empty())
                throw gi::InputError("the task '" + title_of(task) + "' cannot run here", why,
                                     "use a larger machine, or lower its resources in the manifest");
            pending_.push_back(i);
        }
        out_.was_done = out_.counts.done;
        show();
    }

    void start_tasks()
    {
        auto const publishing = [&] {
            return std::size_t(std::ranges::count(running_, true, &Running::is_prepared));
        };
        while (!pending_.empty() && publishing() < settings_.machine.cores.size()) { // the disk may be slow
            std::size_t const i = pending_.front();
            Task const& task = batch_.tasks[i];
            if (settings_.ranks > 1 && settle(i)) {
                pending_.pop_front();
                continue;
            }
            auto const share = allocator_.take(task.resources);
            if (!share) return;
            pending_.pop_front();
            running_.push_back(
                {WorkerProcess::start(*share, [&](int pipe) { return work(task, pipe); }), i, *share});
        }
    }

    /// What a worker does.
    int work(Task const& task, int pipe) const
    {
        WorkSettings const settings{settings_.program, IfTaken::leave, [pipe] {
                                        (void)!::write(pipe, "c", 1);
                                        return Publish::here;
                                    }};
        return exit_code_of(work_on(store_, batch_, task, settings, stop_));
    }

    /// Counts a task that another process has done meanwhile, or puts it aside if one runs it.
    bool settle(std::size_t i)
    {
        if (store_.result(batch_.tasks[i].key)) {
            ++out_.counts.done;
            return true;
        }
        if (!Claim(store_.claims(), batch_.tasks[i].key).is_taken_elsewhere()) return false;
        elsewhere_.push_back(i);
        return true;
    }

    void look_elsewhere()
    {
        if (elsewhere_.empty() || Clock::now() < next_look_) return;
        next_look_ = Clock::now() + kLookElsewhere;
        std::vector<std::size_t> look;
        look.swap(elsewhere_);
        for (std::size_t const i : look)
            if (!settle(i)) pending_.push_back(i); // it failed there, or was killed
    }

    void wait_a_moment()
    {
        std::vector<pollfd> pipes;
        for (Running const& r : running_) pipes.push_back({r.worker.pipe, POLLIN, 0});
        ::poll(pipes.data(), nfds_t(pipes.size()), 100);
        for (std::size_t k = 0; k < pipes.size(); ++k) {
            if ((pipes[k].revents & POLLIN) != 0) free_share(running_[k]);
            running_[k].is_ending = (pipes[k].revents & POLLHUP) != 0;
        }
    }

    void free_share(Running& r)
    {
        char told = 0;
        if (r.is_prepared || ::read(r.worker.pipe, &told, 1) != 1) return;
        r.is_prepared = true;
        allocator_.give_back(r.share);
    }

    void end_workers()
    {
        std::erase_if(running_, [&](Running& r) {
            int status = 0; // asking an ending process again and again would keep it from ending
            pid_t const ended = ::waitpid(r.worker.pid, &status, r.is_ending ? 0 : WNOHANG);
            if (ended != r.worker.pid) return false;
            ::close(r.worker.pipe);
            if (!r.is_prepared) allocator_.give_back(r.share);
            count(r.task, status);
            return true;
        });
    }

    void count(std::size_t task, int status)
    {
        int const code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        if (code == kWorkDone) {
            ++out_.counts.done;
        } else if (code == kWorkTaken) {
            elsewhere_.push_back(task);
        } else if (out_.is_interrupted && code == kWorkInterrupted) {
            pending_.push_front(task); // for those who resume
        } else if ((code < 0 || code == kWorkInterrupted) && ++lost_[task] <= kMostLost) {
            ++out_.lost_workers;
            pending_.push_front(task);
        } else {
            ++out_.counts.failed;
        }
    }

    void interrupt()
    {
        out_.is_interrupted = true;
        for (Running const& r : running_) kill(r.worker.pid, SIGTERM);
        auto const end = Clock::now() + kTimeToEnd;
        while (!running_.empty() && Clock::now() < end) {
            std::vector<pollfd> pipes;
            for (Running const& r : running_) pipes.push_back({r.worker.pipe, 0, 0}); // closed at its end
            ::poll(pipes.data(), nfds_t(pipes.size()), 10);
            end_workers();
        }
        for (Running const& r : running_) kill(r.worker.pid, SIGKILL);
    }

    void show()
    {
        out_.counts.running = running_.size() + elsewhere_.size();
        view_.update(out_.counts);
    }

    Store const& store_;
    Batch const& batch_;
    LocalSettings const& settings_;
    gi::StopRequest const& stop_;
    Allocator allocator_;
    ProgressView view_;
    RunOutcome out_;
    std::deque<std::size_t> pending_;
    std::vector<Running> running_;
    std::vector<std::size_t> elsewhere_;
    std::vector<int> lost_; ///< workers, by task
    Clock::time_point next_look_{};
};

} // namespace

RunOutcome run_locally(Store const& store, Batch const& batch, LocalSettings const& settings,
                       gi::StopRequest const& stop)
{
    return Runner(store, batch, settings, stop).run();
}

} // namespace viewer::batch
