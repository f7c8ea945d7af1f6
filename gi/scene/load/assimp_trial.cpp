#include "gi/scene/load/assimp_trial.h"

#include "gi/scene/load/assimp_reader.h"

#include <algorithm>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <new>
#include <optional>
#include <set>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace gi {
namespace {

namespace fs = std::filesystem;

#if defined(__SANITIZE_ADDRESS__)
constexpr rlim_t kSlower = 10; ///< checked memory
#else
constexpr rlim_t kSlower = 1;
#endif
constexpr int kAttempts = 2; ///< because the first may stall on a lock, see run_child
constexpr rlim_t kMiB = rlim_t(1) << 20, kBytes = rlim_t(1) << 30, kBytesPerByte = 64;
constexpr std::size_t kLongestReason = 4096;

rlim_t seconds(AssimpTrial const& trial) { return kSlower * (5 + trial.file_bytes / kMiB); }
rlim_t memory_bytes(AssimpTrial const& trial) { return kBytes + kBytesPerByte * trial.file_bytes; }

/// Size of this process's address space, bytes.
[[maybe_unused]] rlim_t used_memory()
{
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * rlim_t(sysconf(_SC_PAGESIZE));
}

void limit(int resource, rlim_t most)
{
    rlimit now{};
    getrlimit(__rlimit_resource_t(resource), &now);
    now.rlim_cur = std::min(most, now.rlim_max);
    setrlimit(__rlimit_resource_t(resource), &now);
}

void limit_to(AssimpTrial const& trial)
{
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    limit(RLIMIT_CPU, rlim_t(used.ru_utime.tv_sec + used.ru_stime.tv_sec + 1) + seconds(trial));
#if !defined(__SANITIZE_ADDRESS__)
    limit(RLIMIT_AS, used_memory() + memory_bytes(trial));
#endif
}

/// Tries one file after the other and writes for each the length of the reason, and the reason.
[[noreturn]] void try_all(std::deque<AssimpTrial> const& trials, int pipe)
{
    limit(RLIMIT_CORE, 0);
    if (int const null = open("/dev/null", O_WRONLY); null >= 0) dup2(null, STDERR_FILENO);
    for (int const s : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGINT, SIGTERM, SIGHUP, SIGXCPU})
        signal(s, SIG_DFL);
    AssimpReader reader;
    for (AssimpTrial const& trial : trials) {
        limit_to(trial);
        std::string told = reader.read(trial.file, trial.faces).substr(0, kLongestReason);
        auto const length = std::uint32_t(told.size());
        told.insert(0, reinterpret_cast<char const*>(&length), sizeof length);
        if (write(pipe, told.data(), told.size()) != ssize_t(told.size())) _exit(1);
    }
    _exit(0);
}

/// Takes the first reason for failure that a child has reported, if it is complete.
std::optional<std::string> take_reason(std::string& told)
{
    std::uint32_t length = 0;
    if (told.size() < sizeof length) return std::nullopt;
    std::memcpy(&length, told.data(), sizeof length);
    if (told.size() < sizeof length + length) return std::nullopt;
    std::string reason = told.substr(sizeof length, length);
    told.erase(0, sizeof length + length);
    return reason;
}

/// Why the child ended at this file. @param status  from waitpid; nothing = it stalled
std::string end_of_child(AssimpTrial const& trial, std::optional<int> status)
{
    if (!status) return "its reader (Assimp) waits for something, perhaps for a file that it refers to";
    if (WIFSIGNALED(*status) && WTERMSIG(*status) == SIGXCPU)
        return fmt::format(
            "its reader (Assimp) did not finish in {} s of processor time, which a file of {} bytes gets",
            seconds(trial), trial.file_bytes);
    return "its reader (Assimp) crashed on it";
}

std::string in_our_words(std::string reason, AssimpTrial const& trial)
{
    if (reason == std::bad_alloc().what())
        return fmt::format(
            "its reader (Assimp) asked for more than {} MiB of memory, which a file of {} bytes gets",
            memory_bytes(trial) / kMiB, trial.file_bytes);
    return reason;
}

thread_local AssimpTrials* t_trials = nullptr;

} // namespace

AssimpTrials::AssimpTrials(std::vector<fs::path> const& files, AssimpFaces faces)
    : faces_(faces), before_(std::exchange(t_trials, this))
{
    std::set<std::string> seen;
    for (fs::path const& file : files) {
        std::error_code error;
        if (!seen.insert(file.string()).second || !fs::is_regular_file(file, error)) continue;
        std::uintmax_t const bytes = fs::file_size(file, error);
        if (error || bytes == 0) continue;
        left_.push_back({file, faces, bytes});
    }
}

AssimpTrials::~AssimpTrials() { t_trials = before_; }

void AssimpTrials::first_ended(std::string why)
{
    outcomes_[left_.front().file.string()] = std::move(why);
    left_.pop_front();
    stalls_ = 0;
}

/// Waits for more outcomes.
void AssimpTrials::go_on()
{
    if (!child_) {
        told_.clear();
        child_.emplace([this](int pipe) { try_all(left_, pipe); });
    }
    bool const runs = child_->read(told_);
    while (auto reason = take_reason(told_)) first_ended(in_our_words(std::move(*reason), left_.front()));
    if (runs || left_.empty()) return;
    std::optional<int> const status = child_->status();
    child_.reset();
    if (status || ++stalls_ == kAttempts) first_ended(end_of_child(left_.front(), status));
}

std::optional<std::string> AssimpTrials::outcome(fs::path const& file, AssimpFaces faces)
{
    auto const is_asked = [&](AssimpTrial const& t) { return t.file.native() == file.native(); };
    if (faces != faces_) return std::nullopt;
    while (true) {
        if (auto const found = outcomes_.find(file.string()); found != outcomes_.end()) return found->second;
        if (std::ranges::none_of(left_, is_asked)) return std::nullopt;
        go_on();
    }
}

std::optional<std::string> AssimpTrials::known_outcome(fs::path const& file, AssimpFaces faces)
{
    for (AssimpTrials* trials = t_trials; trials != nullptr; trials = trials->before_)
        if (auto found = trials->outcome(file, faces)) return found;
    return std::nullopt;
}

} // namespace gi
