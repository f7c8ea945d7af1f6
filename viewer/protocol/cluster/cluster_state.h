#pragma once
// The inside of a Cluster: what each rank knows of the others, and what messages do to that.

#include "viewer/protocol/cluster/clock_offset.h"
#include "viewer/protocol/cluster/cluster.h"
#include "viewer/protocol/cluster/messenger.h"
#include "viewer/protocol/cluster/process_watch.h"

#include <functional>
#include <optional>

namespace viewer {

struct Cluster::State {
    /// Ready to swap.
    struct Arrival {
        std::uint64_t frame = 0, check = 0;
    };
    struct Swap {
        std::uint64_t frame = 0;
        double time_s = 0;
        bool known = false;
    };
    struct Peer {
        std::string host;
        ProcessId process;
        bool there = false; ///< has said hello; of the leader always
        bool lost = false;
        bool said_goodbye = false;
        double heard_s = 0; ///< on the clock listened_s
        RoundTripClockOffset clock;
        std::optional<Arrival> arrival;
        std::string note; ///< that came with it
        std::deque<std::vector<std::uint8_t>> data;
    };

    State(ClusterIdentity identity, ClusterSettings settings);
    void start();

    /// Moves messages, takes note of what they say, and of processes that have ended. Throws RankLoss.
    void pump();
    /// Until the condition holds. Throws RankLoss where a rank that `waits_for` names is lost, unless all go on.
    void await(std::function<bool()> const& condition, std::function<bool(int)> const& waits_for, double silence_s,
               std::string const& what_for);

    void send(int to, Writer message);
    void send_to_others(Writer const& message);
    void lose(int rank, std::string const& how);
    /// Throws RankLoss.
    [[noreturn]] void stop(std::string const& why);
    void note_order(std::span<std::uint8_t const> bytes);
    void tell_swap(Writer& message);
    std::string name(int rank) const;
    bool leads() const { return rank == 0; }
    /// Of others.
    bool living(int r) const { return r != rank && !peers[std::size_t(r)].lost; }
    bool others_living() const;
    std::vector<int> other_ranks() const;

    void take_messages();
    void handle(Message const& message);
    void hello(int from, Reader& in);
    void started(Reader& in);
    void swap_of(int from, Reader& in);
    void watch_processes();
    void show_life();
    void compare_identities(); ///< throws InputError
    void measure_clocks();

    ClusterIdentity identity;
    ClusterSettings settings;
    int rank = 0, size = 1;
    std::optional<Messenger> messenger; ///< none where alone
    ProcessId here;
    std::vector<Peer> peers; ///< of all ranks, this one, too
    std::vector<ClusterIdentity> identities;
    std::uint64_t orders_check = 0;
    std::deque<std::vector<std::uint8_t>> orders; ///< that have come and were not fetched
    std::optional<std::uint64_t> gone;            ///< the frame of the last `go`
    Echo last_go;                                 ///< that a follower answers
    int pongs = 0, wants = 0;
    bool is_started = false, is_ended = false, over = false;
    bool is_leaving = false; ///< follower: has said goodbye
    Swap swap;               ///< of this rank, not told yet
    SwapLog swaps;
    std::vector<std::string> news;
    std::string broken; ///< why this cluster is no more; empty = it is
    double watched_s = 0, lived_s = 0, pumped_s = 0;
    double listened_s = 0; ///< in all; a clock that stands while this process does not run, or renders
};

} // namespace viewer
