#include "viewer/protocol/cluster/process_watch.h"

#include <array>
#include <fstream>
#include <optional>
#include <sstream>
#include <unistd.h>

namespace viewer {
namespace {

/// Empty where the file cannot be read, also where its process ends between opening and reading (ESRCH).
std::string text_of(std::string const& file)
{
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

struct Stat {
    char state = 0;
    std::uint64_t started = 0;
};

/// Fields 3 and 22 of /proc/PID/stat (proc(5)). Field 2, a name in brackets, may contain any characters.
std::optional<Stat> read_stat(std::int32_t pid)
{
    std::string const text = text_of("/proc/" + std::to_string(pid) + "/stat");
    auto const bracket = text.rfind(')');
    if (bracket == std::string::npos) return {};
    std::istringstream in(text.substr(bracket + 1));
    Stat s;
    in >> s.state;
    std::string skipped;
    for (int field = 4; field < 22; ++field) in >> skipped;
    in >> s.started;
    return in ? std::optional(s) : std::nullopt;
}

} // namespace

ProcessId this_process()
{
    ProcessId id;
    std::array<char, 256> space{};
    if (readlink("/proc/self/ns/pid", space.data(), space.size() - 1) < 0) space = {};
    id.machine = text_of("/proc/sys/kernel/random/boot_id") + space.data();
    id.number = getpid();
    if (auto const stat = read_stat(id.number)) id.started = stat->started;
    return id;
}

ProcessState state_of(ProcessId const& process, ProcessId const& here)
{
    if (process.machine != here.machine || process.started == 0) return ProcessState::unknown;
    auto const stat = read_stat(process.number);
    if (!stat || stat->started != process.started || stat->state == 'Z' || stat->state == 'X')
        return ProcessState::ended;
    return stat->state == 'T' || stat->state == 't' ? ProcessState::stopped : ProcessState::runs;
}

} // namespace viewer
