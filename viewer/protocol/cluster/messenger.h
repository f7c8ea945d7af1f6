#pragma once
// Messages between the processes that mpirun started. Only non-blocking point-to-point calls: a collective would
// wait for a dead rank for ever. The one file that knows MPI is messenger.cpp.

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

/// From one thread at a time, which need not be always the same (MPI_THREAD_SERIALIZED); the thread that makes it
/// is the one that ends it.
class Messenger {
public:
    /// Whether mpirun started this program with others; if not, nothing here is to be made.
    static bool started_with_others();

    /// MPI_Init. Throws InputError where this MPI cannot be called from several threads in turn.
    Messenger();
    Messenger(Messenger const&) = delete;
    Messenger& operator=(Messenger const&) = delete;
    ~Messenger();

    int rank() const { return rank_; }
    int size() const { return size_; }

    /// Begins to send; those to one rank arrive in order. To a rank that is dead: nothing happens.
    void send(int to, std::vector<std::uint8_t> bytes);
    /// What has arrived, in order for each sender.
    std::vector<Message> poll();
    /// Whether all that was sent to a rank has left this process.
    bool sent_all(int to);
    /// Waits until what was sent to these ranks has left.
    void flush(std::span<int const> ranks, double at_most_s);
    /// MPI_Finalize, in which all ranks wait for each other: only where all are alive. Else it is left out, and
    /// the process just ends.
    void finalize();

private:
    struct Transfers;
    int rank_ = 0, size_ = 1;
    std::unique_ptr<Transfers> transfers_;
};

} // namespace viewer
