#pragma once
// Messages between the processes that mpirun started. Uses only non-blocking point-to-point calls, because a
// collective would wait forever for a dead rank. Only the module in mpi/ depends on MPI.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace viewer {

struct Message {
    int from = 0;
    std::vector<std::uint8_t> bytes;
};

/// May be called from one thread at a time, not always the same (MPI_THREAD_SERIALIZED); the thread that creates
/// it must also destroy it.
class Messenger {
public:
    virtual ~Messenger() = default;
    virtual int rank() const = 0;
    virtual int size() const = 0;
    /// Starts sending a message; messages to one rank arrive in order. Does nothing for a dead rank.
    virtual void send(int to, std::vector<std::uint8_t> bytes) = 0;
    /// Received messages, in order for each sender.
    virtual std::vector<Message> poll() = 0;
    /// True if all messages to a rank have left this process.
    virtual bool sent_all(int to) = 0;
    /// Waits until all messages to these ranks have left.
    virtual void flush(std::span<int const> ranks, double at_most_s) = 0;
    /// Calls MPI_Finalize, in which all ranks wait for each other. Call only if all ranks are alive; otherwise
    /// just end the process.
    virtual void finalize() = 0;
};

/// True if mpirun started this program with other ranks; if not, no Messenger may be made.
bool started_with_others();

/// Loads the module that links MPI, and calls MPI_Init. Throws InputError without that module, or if its MPI cannot be
/// called from several threads in turn.
std::unique_ptr<Messenger> make_messenger();

} // namespace viewer

/// The module's function: none if its MPI has no MPI_THREAD_SERIALIZED.
extern "C" viewer::Messenger* lightwell_messenger();
