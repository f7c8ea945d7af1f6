#pragma once
// Several processes, started by mpirun, that show or render together: rank 0 leads,
// the others follow its frame commands. No rank waits forever: a rank that dies or stalls is reported by name,
// and the others stop or continue.
//
// Without mpirun, or with a single rank, all calls do nothing and return at once.
// (mpirun is detected by OMPI_COMM_WORLD_SIZE.)
//
// All calls must come from one thread, not necessarily the main thread: MPI is initialised with
// MPI_THREAD_SERIALIZED, by the thread that creates the Cluster, and finalised by the thread that destroys it. A
// KeepAlive hands the Cluster to its own thread temporarily.
//
//   leader     send(order)  render  wait(frame)  swap  report_swap(frame, now_s())  ...  finish()
//   follower   receive()    render  wait(frame)  swap  report_swap(frame, now_s())  ...  until receive() is empty
//
// Whoever has other things to do meanwhile calls watch() often, and takes each step when it is possible: take_order()
// instead of receive(); arrive(), then may_swap() and, on the leader, release() instead of wait().

#include "viewer/protocol/cluster/swap_log.h"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace viewer {

enum class OnRankLoss : std::uint8_t {
    stop,  ///< all other ranks end too
    go_on, ///< continue without the lost rank, unless it is the leader
};
/// "stop" or "continue". Throws InputError.
OnRankLoss parse_on_rank_loss(std::string const& text);

struct ClusterSettings {
    OnRankLoss on_loss = OnRankLoss::stop;
    double silence_s = 5; ///< a rank that others wait for is lost after this time without a sign of life; > 0
    double start_s = 60;  ///< the same, for ranks that have not yet started
};

/// Data that must be equal on all ranks at the start.
struct ClusterIdentity {
    std::string program;       ///< name and version
    std::string work;          ///< description of what is shown or rendered
    std::uint64_t content = 0; ///< hash of the input files
};

/// Hash of a file's content; 0 if `file` is not a file (the name of a generated scene).
std::uint64_t file_hash(std::string const& file);

/// Thrown if a rank is lost, or the others dropped this rank. The command prints it and exits with code 1.
class RankLoss : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// How a rank ended, as the leader knows at the end.
struct RankEnd {
    int rank = 0;
    std::string name;     ///< "rank 2 on HOST"
    std::string lost;     ///< how it was lost; empty = it was not
    std::string farewell; ///< its last words; empty = none came
};

/// Any call throws RankLoss if this rank must stop; after that only the destructor may be called.
class Cluster {
public:
    /// Waits for all ranks. Throws InputError, on all ranks, if their identities differ.
    explicit Cluster(ClusterIdentity const& identity, ClusterSettings const& settings = {});
    /// If neither finish() nor leave() was called, notifies the others that this rank ended early.
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
    /// One sentence per rank lost since the last call. With OnRankLoss::go_on.
    std::vector<std::string> take_news();

    /// Processes pending messages, and throws RankLoss if this rank must stop. Optional.
    void check();

    /// check() for a rank that waits for others: why it waits for this one, e.g. "at the end"; empty = it does not.
    /// One that shows no sign of life for so long is lost.
    void watch(std::function<std::string(int rank)> const& why);
    bool lost(int rank) const;

    // Frames.
    /// Leader: sends an order to all others.
    void send(std::span<std::uint8_t const> order);
    /// Follower: waits for the next order. None: the leader has finished.
    std::optional<std::vector<std::uint8_t>> receive();
    /// Follower: the next order, if one has come.
    std::optional<std::vector<std::uint8_t>> take_order();
    bool ended() const; ///< follower: the leader has finished
    /// Hash of all orders that were sent or taken.
    std::uint64_t orders_check() const;
    /// Waits before the swap until all ranks are ready. Compares a hash of all orders so far; a rank with
    /// a different hash is lost. @param check  optional hash of the results, compared likewise
    /// @param note  short message to the leader  @return on the leader: the notes of the others
    std::vector<std::string> wait(std::uint64_t frame, std::uint64_t check = 0, std::string const& note = {});
    /// Follower: is ready to swap. @param state  to be compared, e.g. orders_check()  @param note  as in wait()
    void arrive(std::uint64_t frame, std::uint64_t state, std::string const& note);
    /// Leader: the others are ready. Follower: all are, the leader says.
    bool may_swap(std::uint64_t frame) const;
    /// Leader: all may swap. Those with another state are lost. @return notes of the others
    std::vector<std::string> release(std::uint64_t frame, std::uint64_t state);
    /// @param time_s  on this process's steady clock
    void report_swap(std::uint64_t frame, double time_s);
    /// Leader: statistics of all reported frames.
    SwapSkew swap_skew() const;
    /// std::chrono::steady_clock, s
    static double now_s();
    /// Leader: how far a rank's clock is ahead of the leader's, and the maximum error of this, s.
    std::pair<double, double> clock_ahead_s(int rank) const;

    // Messages of any rank to any other, at most 1 GiB each.
    void tell(int to, std::span<std::uint8_t const> message);
    struct Heard {
        int from = 0;
        std::vector<std::uint8_t> message;
    };
    /// Those that have come, in the order of each sender.
    std::vector<Heard> heard();

    // Other work, in pieces of at most 1 GiB.
    /// Follower: sends data to the leader; waits until the leader calls take().
    void give(std::vector<std::uint8_t> bytes);
    /// Leader: the next data that the rank gives; none if it is lost.
    /// Waits as long as that rank shows signs of life.
    std::optional<std::vector<std::uint8_t>> take(int from);

    /// Follower: its message to the leader when it ends normally, e.g. its losses; called then, on any thread.
    void set_farewell(std::function<std::string()> farewell);
    /// Leader: of the other ranks.
    std::vector<RankEnd> ends() const;

    /// Leader: ends the session; followers' receive() then returns none. Follower: waits for that.
    void finish();
    /// Ends early and sends the reason to the others, for which this rank is lost.
    void leave(std::string const& why);

private:
    friend class KeepAlive;
    struct State;
    std::unique_ptr<State> state_;
};

/// While this object exists, it sends signs of life to the other ranks, and the Cluster must not be called. For
/// work that may take longer than ClusterSettings::silence_s: loading a scene, a picture of many paths.
class KeepAlive {
public:
    /// @param on_loss  called from the other thread if the cluster must stop;
    /// the next Cluster call throws RankLoss
    explicit KeepAlive(Cluster& cluster, std::function<void()> on_loss = {});
    ~KeepAlive();
    KeepAlive(KeepAlive const&) = delete;
    KeepAlive& operator=(KeepAlive const&) = delete;

private:
    struct Thread;
    std::unique_ptr<Thread> thread_;
};

} // namespace viewer
