#include "viewer/report/machine.h"

#include "gi/core/shell.h"

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fmt/chrono.h>
#include <fstream>
#include <sched.h>
#include <sys/utsname.h>

namespace viewer {
namespace {

/// Text after "key :" in a file such as /proc/cpuinfo; empty if not found.
std::string value_of(char const* file, std::string const& key)
{
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        auto const colon = line.find(':');
        if (!line.starts_with(key) || colon == std::string::npos) continue;
        auto const first = line.find_first_not_of(" \t", colon + 1);
        return first == std::string::npos ? "" : line.substr(first);
    }
    return "";
}

} // namespace

MachineFacts this_machine()
{
    MachineFacts machine;
    machine.cpu = value_of("/proc/cpuinfo", "model name");
    if (machine.cpu.empty()) machine.cpu = "unknown";
    cpu_set_t usable;
    CPU_ZERO(&usable);
    if (sched_getaffinity(0, sizeof usable, &usable) == 0) machine.cores = CPU_COUNT(&usable);
    machine.memory_gib = std::strtod(value_of("/proc/meminfo", "MemTotal").c_str(), nullptr) / (1024 * 1024); // kB
    return machine;
}

std::string to_text(MachineFacts const& m)
{
    return fmt::format("{} core{} of {}, {:.0f} GiB", m.cores, m.cores == 1 ? "" : "s", m.cpu, m.memory_gib);
}

std::string operating_system()
{
    std::string name = "unknown";
    std::ifstream in("/etc/os-release");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("PRETTY_NAME=")) {
            name = line.substr(12);
            std::erase(name, '"');
        }
    utsname kernel{};
    return uname(&kernel) == 0 ? fmt::format("{}, {} {}", name, kernel.sysname, kernel.release) : name;
}

std::string this_command()
{
    std::ifstream in("/proc/self/cmdline", std::ios::binary);
    std::string command;
    for (std::string word; std::getline(in, word, '\0');)
        command +=
            command.empty() ? std::filesystem::path(word).filename().string() : " " + gi::shell_quoted(word);
    return command;
}

std::string this_moment() { return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr))); }

} // namespace viewer
