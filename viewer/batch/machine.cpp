#include "viewer/batch/machine.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <sched.h>

namespace viewer::batch {
namespace {

std::uint64_t available_memory()
{
    std::ifstream in("/proc/meminfo");
    std::string key, unit;
    std::uint64_t kilobytes = 0;
    while (in >> key >> kilobytes >> unit)
        if (key == "MemAvailable:") return kilobytes * 1024;
    return 0;
}

/// Removes and returns the first `count`.
std::vector<int> take_first(std::vector<int>& from, std::size_t count)
{
    std::vector<int> const out(from.begin(), from.begin() + std::ptrdiff_t(count));
    from.erase(from.begin(), from.begin() + std::ptrdiff_t(count));
    return out;
}

} // namespace

Machine this_machine()
{
    Machine m;
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) == 0)
        for (int i = 0; i < CPU_SETSIZE; ++i)
            if (CPU_ISSET(i, &set)) m.cores.push_back(i);
    if (m.cores.empty()) m.cores.push_back(0);
    std::error_code none;
    while (std::filesystem::exists(fmt::format("/dev/nvidia{}", m.gpus.size()), none))
        m.gpus.push_back(int(m.gpus.size()));
    m.memory_bytes = available_memory();
    return m;
}

Machine part_of(Machine const& machine, int index, int count)
{
    auto const part = [&](std::vector<int> const& all) {
        std::vector<int> mine;
        for (std::size_t i = std::size_t(index); i < all.size(); i += std::size_t(count)) mine.push_back(all[i]);
        return mine;
    };
    Machine m{part(machine.cores), part(machine.gpus), machine.memory_bytes / std::uint64_t(count)};
    if (m.cores.empty()) m.cores.push_back(machine.cores[std::size_t(index) % machine.cores.size()]);
    return m;
}

void set_cores(Machine& machine, int cores)
{
    std::size_t const there = machine.cores.size();
    machine.cores.resize(std::size_t(cores));
    for (std::size_t i = there; i < machine.cores.size(); ++i) machine.cores[i] = machine.cores[i - there];
}

Allocator::Allocator(Machine const& machine)
    : all_(machine), free_cores_(machine.cores), free_gpus_(machine.gpus), free_memory_(machine.memory_bytes)
{
}

std::string Allocator::refusal(Resources const& wanted) const
{
    if (std::size_t(wanted.gpus) > all_.gpus.size())
        return fmt::format("it needs {} GPUs, this machine has {}", wanted.gpus, all_.gpus.size());
    if (wanted.memory_bytes > all_.memory_bytes)
        return fmt::format("it needs {:.1f} GB of memory, this machine has {:.1f} GB available",
                           double(wanted.memory_bytes) * 1e-9, double(all_.memory_bytes) * 1e-9);
    return {};
}

std::optional<Share> Allocator::take(Resources const& wanted)
{
    std::size_t const cores = wanted.cores == Resources::kAllCores
                                  ? all_.cores.size()
                                  : std::min(std::size_t(wanted.cores), all_.cores.size());
    if (cores > free_cores_.size() || std::size_t(wanted.gpus) > free_gpus_.size() ||
        wanted.memory_bytes > free_memory_)
        return std::nullopt;
    free_memory_ -= wanted.memory_bytes;
    return Share{take_first(free_cores_, cores), take_first(free_gpus_, std::size_t(wanted.gpus)),
                 wanted.memory_bytes};
}

void Allocator::give_back(Share const& share)
{
    free_cores_.insert(free_cores_.end(), share.cores.begin(), share.cores.end());
    free_gpus_.insert(free_gpus_.end(), share.gpus.begin(), share.gpus.end());
    free_memory_ += share.memory_bytes;
}

} // namespace viewer::batch
