#pragma once
// Starts ranks as their users do: by mpirun, in a folder of their own.

#include "tests/viewer/run_program.h"

#include <fcntl.h>

namespace viewer::test {

inline bool has_mpirun() { return std::system("mpirun --version > /dev/null 2>&1") == 0; }

/// What leaves the other ranks running when one is killed.
inline std::string const& recovery_option()
{
    static std::string const option = [] {
        bool const is_fifth = std::system("mpirun --version | grep -q 'Open MPI) [5-9]'") == 0;
        return std::string(is_fifth ? "--enable-recovery --with-ft mpi" : "--enable-recovery");
    }();
    return option;
}

/// A running mpirun with all that it started; its output is in FOLDER/mpirun.out. It ends at the end.
class Mpirun {
public:
    /// @param command  of one rank, split at blanks, with a full path
    Mpirun(int ranks, std::string const& options, std::string const& command, std::filesystem::path const& folder)
        : folder_(folder)
    {
        setenv("HWLOC_COMPONENTS", "-gl", 0); // other tests start and end X servers
        std::vector<std::string> arguments =
            words("mpirun --allow-run-as-root --oversubscribe --bind-to none --mca orte_tmpdir_base " +
                  own_.path().string() + " -n " + std::to_string(ranks) + " " + options + " " + command);
        std::vector<char*> argv;
        for (std::string& a : arguments) argv.push_back(a.data());
        argv.push_back(nullptr);
        std::string const out = folder / "mpirun.out";
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
        posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
        posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
        int const error = posix_spawnp(&pid_, "mpirun", &actions, nullptr, argv.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        if (error != 0) throw std::runtime_error("cannot run mpirun");
    }
    ~Mpirun()
    {
        if (pid_ > 0) wait(std::chrono::seconds(0));
    }
    Mpirun(Mpirun const&) = delete;
    Mpirun& operator=(Mpirun const&) = delete;

    /// @return mpirun's exit code; -1 where it had to be ended
    int wait(std::chrono::seconds limit = std::chrono::seconds(120))
    {
        auto const end = std::chrono::steady_clock::now() + limit;
        int status = 0;
        bool asked = false;
        while (waitpid(pid_, &status, WNOHANG) == 0) {
            if (!asked && std::chrono::steady_clock::now() > end) {
                if (limit.count() > 0) ADD_FAILURE() << "mpirun still runs after " << limit.count() << " s";
                kill(pid_, SIGTERM); // it ends its ranks
                asked = true;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        pid_ = 0;
        return !asked && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    std::string text() const { return file_text(folder_ / "mpirun.out"); }

private:
    std::filesystem::path folder_;
    TemporaryFolder own_; ///< what mpirun keeps meanwhile; else all of them share one in /tmp, and tidy it up
    pid_t pid_ = 0;
};

} // namespace viewer::test
