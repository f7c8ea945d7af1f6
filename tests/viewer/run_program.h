#pragma once
// Runs the program as its users do: as a child, in a folder of its own.

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <memory>
#include <spawn.h>
#include <sstream>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace viewer::test {

/// A new folder, deleted with all that is in it at the end.
class TemporaryFolder {
public:
    TemporaryFolder()
    {
        std::string name = (std::filesystem::temp_directory_path() / "lightwell_test_XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
        path_ = name;
    }
    ~TemporaryFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(TemporaryFolder const&) = delete;
    TemporaryFolder& operator=(TemporaryFolder const&) = delete;

    std::filesystem::path const& path() const { return path_; }
    std::filesystem::path operator/(std::string const& name) const { return path_ / name; }
    /// Names of all files, temporaries and hidden ones included, sorted.
    std::vector<std::string> files() const
    {
        std::vector<std::string> names;
        for (auto const& entry : std::filesystem::directory_iterator(path_))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }

private:
    std::filesystem::path path_;
};

inline std::string file_text(std::filesystem::path const& file)
{
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Split at blanks.
inline std::vector<std::string> words(std::string const& text)
{
    std::istringstream in(text);
    return {std::istream_iterator<std::string>(in), {}};
}

/// What is tested: the program of this build, or the one that LIGHTWELL_TEST_PROGRAM names.
inline std::string program_path()
{
    char const* const other = std::getenv("LIGHTWELL_TEST_PROGRAM");
    return other != nullptr && *other != '\0' ? other : LIGHTWELL_PROGRAM;
}

struct Outcome {
    int code = -1;  ///< exit code; -1 where a signal ended it
    int signal = 0; ///< that ended it
    std::string out, err;
};

constexpr std::chrono::seconds kProgramLimit{600}; ///< of a program that hangs; machines may be busy

/// A running lightwell. Whatever still runs at the end is killed.
class Program {
public:
    Program(std::vector<std::string> arguments, std::filesystem::path const& folder)
        : out_(std::tmpfile(), &std::fclose), err_(std::tmpfile(), &std::fclose)
    {
        std::string const program = program_path();
        arguments.insert(arguments.begin(), program);
        std::vector<char*> argv;
        for (std::string& a : arguments) argv.push_back(a.data());
        argv.push_back(nullptr);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
        posix_spawn_file_actions_adddup2(&actions, fileno(out_.get()), STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&actions, fileno(err_.get()), STDERR_FILENO);
        int const error = posix_spawn(&pid_, program.c_str(), &actions, nullptr, argv.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        if (error != 0) throw std::runtime_error("cannot run " + program + ": build it first");
    }
    ~Program()
    {
        if (pid_ > 0) {
            kill(pid_, SIGKILL);
            waitpid(pid_, nullptr, 0);
        }
    }
    Program(Program const&) = delete;
    Program& operator=(Program const&) = delete;

    void send(int signal) const { kill(pid_, signal); }
    pid_t pid() const { return pid_; } ///< 0 once it was waited for
    bool runs() const
    {
        siginfo_t ended{};
        return pid_ > 0 && waitid(P_PID, id_t(pid_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
               ended.si_pid == 0;
    }
    /// Written so far.
    std::string errors() const
    {
        std::string text(1 << 16, '\0'); // pread: the program writes by the same file position
        ssize_t const n = pread(fileno(err_.get()), text.data(), text.size(), 0);
        text.resize(n > 0 ? std::size_t(n) : 0);
        return text;
    }

    /// Waits until the program handles a signal itself (or no longer does); false if it ends before that.
    bool wait_until_catches(int signal, bool catches) const
    {
        while (true) {
            std::istringstream status(file_text("/proc/" + std::to_string(pid_) + "/status"));
            std::string key, state;
            unsigned long long caught = 0;
            for (std::string line; std::getline(status, line);) {
                if (line.starts_with("State:")) state = line.substr(7, 1);
                if (line.starts_with("SigCgt:")) caught = std::stoull(line.substr(7), nullptr, 16);
            }
            if (state.empty() || state == "Z") return false;
            if (((caught >> (signal - 1)) & 1) == (catches ? 1u : 0u)) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }

    Outcome wait(std::chrono::seconds limit = kProgramLimit)
    {
        auto const end = std::chrono::steady_clock::now() + limit;
        int status = 0;
        while (waitpid(pid_, &status, WNOHANG) == 0) {
            if (std::chrono::steady_clock::now() > end) {
                ADD_FAILURE() << "still running after " << limit.count() << " s";
                kill(pid_, SIGKILL);
                waitpid(pid_, &status, 0);
                break;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        pid_ = 0;
        Outcome outcome;
        if (WIFEXITED(status)) outcome.code = WEXITSTATUS(status);
        if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
        outcome.out = text_of(out_.get());
        outcome.err = text_of(err_.get());
        return outcome;
    }

private:
    using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

    static std::string text_of(std::FILE* file)
    {
        std::string text;
        char chunk[4096];
        std::rewind(file);
        for (std::size_t n = 0; (n = std::fread(chunk, 1, sizeof chunk, file)) > 0;) text.append(chunk, n);
        return text;
    }

    pid_t pid_ = 0;
    File out_, err_;
};

/// Runs `lightwell ARGUMENTS` (split at blanks) to its end.
inline Outcome run(std::string const& arguments, std::filesystem::path const& folder,
                   std::chrono::seconds limit = kProgramLimit)
{
    return Program(words(arguments), folder).wait(limit);
}

/// As above for calls that have to work.
inline Outcome run_well(std::string const& arguments, std::filesystem::path const& folder,
                        std::chrono::seconds limit = kProgramLimit)
{
    Outcome const o = run(arguments, folder, limit);
    EXPECT_EQ(o.code, 0) << "lightwell " << arguments << "\n" << o.err << "signal " << o.signal;
    return o;
}

} // namespace viewer::test
