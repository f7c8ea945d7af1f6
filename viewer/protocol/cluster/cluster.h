#pragma once
// Several processes, started by mpirun, that show or render one thing: rank 0 leads, the others follow its orders
// frame by frame. No rank waits for ever: one that dies or stalls is named, and the rest stop or go on.
//
// Not started by mpirun, or alone: nothing is done, and no call waits. (mpirun is known by OMPI_COMM_WORLD_SIZE.)
//
// All calls come from one thread, which need not be the main thread: MPI is asked for MPI_THREAD_SERIALIZED, and
// is begun and ended by the thread that makes and destroys the Cluster. A KeepAlive lends it to a thread of its
// own.
//
//   leader     send(order)  render  wait(frame)  swap  report_swap(frame, now_s())  ...  finish()
//   follower   receive()    render  wait(frame)  swap  report_swap(frame, now_s())  ...  until receive() is empty

#include "viewer/protocol/cluster/swap_log.h"
#include "viewer/protocol/frame_command.h"

#include <functional>
#include <memory>
#include <stdexcept>

namespace viewer {

enum class OnRankLoss : std::uint8_t {
    stop,  ///< all others end, too
    go_on, ///< without it; but not without the leader
};
/// "stop" or "continue". Throws InputError.
OnRankLoss parse_on_rank_loss(std::string const& text);

struct ClusterSettings {
    OnRankLoss on_loss = OnRankLoss::stop;
    double silence_s = 5; ///< a rank that is waited for is lost after so long without a sign of life; > 0
    double start_s = 60;  ///< the same, for those that have not yet come at all
};

/// What all ranks have to agree on at the start.
struct ClusterIdentity {
    std::string program;       ///< with its version
    std::string work;          ///< what is shown or rendered
    std::uint64_t content = 0; ///< hash of the files that this is made from
};

/// Of the content of a file, or of 0 where `file` is none (the name of a generated scene).
std::uint64_t file_hash(std::string const& file);

/// A rank is lost, or this one was left behind. The command prints it, ends, and returns 1.
class RankLoss : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Any call throws RankLoss where it must stop; after that nothing but the destructor may be called.
class Cluster {
public:
    /// Waits for all ranks. Throws InputError, on all ranks, where one of them has another identity.
    explicit Cluster(ClusterIdentity const& identity, ClusterSettings const& settings = {});
    /// Where neither finish() nor leave() was called, others are told that this rank ended early.
    ~Cluster();
    Cluster(Cluster const&) = delete;
    Cluster& operator=(Cluster const&) = delete;

    static bool started_by_mpirun();

    int rank() const;
    int size() const; ///< at the start, 1 = alone
    bool alone() const { return size() == 1; }
    bool leads() const { return rank() == 0; }
    std::string name(int rank) const; ///< "rank 2 on HOST"
    std::string name() const { return name(rank()); }
    /// Ranks lost so far, each as a sentence; those that were not fetched yet. With OnRankLoss::go_on.
    std::vector<std::string> take_news();

    /// Takes note of what others say, and throws RankLoss where this rank has to stop. No call needs it.
    void check();

    // Frames.
    /// Leader: to all others.
    void send(FrameCommand const& order);
    /// Follower: waits for the next order. Nothing: the leader has finished, and so have we.
    std::optional<FrameCommand> receive();
    /// Before the swap: until all ranks are there. All orders so far are compared by a hash; a rank that got
    /// others is lost. @param check of what was made of them, where there is such a thing; compared likewise
    /// @param note  for the leader: bytes, as short as possible  @return of the leader: the notes of others
    std::vector<std::string> wait(std::uint64_t frame, std::uint64_t check = 0, std::string const& note = {});
    /// @param time_s on this process's steady clock
    void report_swap(std::uint64_t frame, double time_s);
    /// Leader: of all frames that were reported.
    SwapSkew swap_skew() const;
    /// std::chrono::steady_clock, s
    static double now_s();
    /// How far the clock of a rank is ahead of the leader's, and the largest error of that, s. Leader.
    std::pair<double, double> clock_ahead_s(int rank) const;

    // Other work, in pieces of at most 1 GiB.
    /// Follower: to the leader, when it takes it.
    void give(std::vector<std::uint8_t> bytes);
    /// Leader: what the rank gives next; nothing if it is lost. Waits as long as that rank shows signs of life.
    std::optional<std::vector<std::uint8_t>> take(int from);

    /// Leader: all is done; followers' receive() says so. Follower: waits for that.
    void finish();
    /// Ends early, and says why to the others: for them this rank is lost.
    void leave(std::string const& why);

private:
    friend class KeepAlive;
    struct State;
    std::unique_ptr<State> state_;
};

/// While it lives, the other ranks hear that this one is at work, and nothing else may be called. For work that
/// may take longer than ClusterSettings::silence_s: loading a scene, a picture of many paths.
class KeepAlive {
public:
    /// @param on_loss  called from the other thread where the cluster has to stop; the next call throws RankLoss
    explicit KeepAlive(Cluster& cluster, std::function<void()> on_loss = {});
    ~KeepAlive();
    KeepAlive(KeepAlive const&) = delete;
    KeepAlive& operator=(KeepAlive const&) = delete;

private:
    struct Thread;
    std::unique_ptr<Thread> thread_;
};

} // namespace viewer
