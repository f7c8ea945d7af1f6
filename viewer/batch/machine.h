#pragma once
// Resources of a machine (processors, GPUs, memory), and which of them tasks occupy.

#include "viewer/batch/task.h"

#include <optional>
#include <vector>

namespace viewer::batch {

struct Machine {
    std::vector<int> cores; ///< numbers of the processors that may be used
    std::vector<int> gpus;  ///< their numbers
    std::uint64_t memory_bytes = 0;
};

/// This machine: processors that this process may use, memory that is available, NVIDIA's GPUs.
Machine this_machine();
/// The part of a machine that one of several processes may use: at least one core.
Machine part_of(Machine const& machine, int index, int count);
/// As many cores as wanted: the first ones, or each several times, for more tasks at a time than processors.
void set_cores(Machine& machine, int cores);

/// Cores, GPUs and memory that a task has.
struct Share {
    std::vector<int> cores, gpus;
    std::uint64_t memory_bytes = 0;
};

/// Hands out the parts of a machine.
class Allocator {
public:
    explicit Allocator(Machine const& machine);
    /// Why a task can never run here; empty = it can.
    std::string refusal(Resources const& wanted) const;
    /// Nothing if the machine is too busy. A task that wants more cores than there are gets all.
    std::optional<Share> take(Resources const& wanted);
    void give_back(Share const& share);

private:
    Machine all_;
    std::vector<int> free_cores_, free_gpus_;
    std::uint64_t free_memory_;
};

} // namespace viewer::batch
