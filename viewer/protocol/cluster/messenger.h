#pragma once
// Messages between the processes that mpirun started. Uses only non-blocking point-to-point calls, because a
// collective would wait forever for a dead rank. Only messenger.cpp depends on MPI.

#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <string>
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
    /// True if mpirun started this program with other ranks; if not, no Messenger may be created.
    static bool started_with_others();

    /// Calls MPI_Init. Throws InputError if this MPI cannot be called from several threads in turn.
    Messenger();
    Messenger(Messenger const&) = delete;
    Messenger& operator=(Messenger const&) = delete;
    ~Messenger();

    int rank() const { return rank_; }
    int size() const { return size_; }

    /// Starts sending a message; messages to one rank arrive in order. Does nothing for a dead rank.
    void send(int to, std::vector<std::uint8_t> bytes);
    /// Received messages, in order for each sender.
    std::vector<Message> poll();
    /// True if all messages to a rank have left this process.
    bool sent_all(int to);
    /// Waits until all messages to these ranks have left.
    void flush(std::span<int const> ranks, double at_most_s);
    /// Calls MPI_Finalize, in which all ranks wait for each other. Call only if all ranks are alive; otherwise
    /// just end the process.
    void finalize();

private:
    struct Transfers;
    int rank_ = 0, size_ = 1;
    std::unique_ptr<Transfers> transfers_;
};

} // namespace viewer
