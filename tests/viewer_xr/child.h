#pragma once
// Programs that run beside a test: a display server, a runtime, its clients. Killed at the end of their scope.

#include "tests/viewer/run_program.h"

#include <fcntl.h>
#include <functional>
#include <optional>

namespace viewer::test {

using Seconds = std::chrono::duration<double>;

/// False where it did not come true in time.
inline bool wait_for(std::function<bool()> const& condition, Seconds limit)
{
    auto const end = std::chrono::steady_clock::now() + limit;
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
}

class Child {
public:
    /// The program is sought in PATH; stdout and stderr go to files `name`.out and .err of the folder. NAME=VALUE
    /// pairs are added to the environment.
    Child(std::vector<std::string> arguments, std::filesystem::path const& folder, std::string const& name,
          std::vector<std::string> const& environment = {})
        : out_(folder / (name + ".out")), err_(folder / (name + ".err"))
    {
        arguments.insert(arguments.begin(), environment.begin(), environment.end());
        arguments.insert(arguments.begin(), "env");
        std::vector<char*> argv;
        for (std::string& a : arguments) argv.push_back(a.data());
        argv.push_back(nullptr);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                         0600);
        posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                         0600);
        int const error = posix_spawnp(&pid_, "env", &actions, nullptr, argv.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        if (error != 0) throw std::runtime_error("cannot start " + name);
    }
    ~Child()
    {
        if (is_running()) kill(pid_, SIGTERM);
        if (!wait_for([&] { return !is_running(); }, Seconds(3))) stop_at_once();
    }
    Child(Child const&) = delete;
    Child& operator=(Child const&) = delete;

    bool is_running()
    {
        if (!status_ && waitpid(pid_, &wait_status_, WNOHANG) == pid_) status_ = wait_status_;
        return !status_;
    }
    void stop_at_once()
    {
        if (!is_running()) return;
        kill(pid_, SIGKILL);
        waitpid(pid_, &wait_status_, 0);
        status_ = wait_status_;
    }
    /// Its exit code; -1 where a signal ended it or it did not end in time.
    int wait(Seconds limit)
    {
        if (!wait_for([&] { return !is_running(); }, limit)) {
            ADD_FAILURE() << "still running after " << limit.count() << " s\n" << out() << err();
            stop_at_once();
        }
        return WIFEXITED(*status_) ? WEXITSTATUS(*status_) : -1;
    }
    std::string out() const { return file_text(out_); }
    std::string err() const { return file_text(err_); }

private:
    std::filesystem::path out_, err_;
    pid_t pid_ = 0;
    int wait_status_ = 0;
    std::optional<int> status_;
};

} // namespace viewer::test
