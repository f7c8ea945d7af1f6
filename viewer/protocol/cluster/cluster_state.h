#pragma once
// Internal state of a Cluster: what this rank knows of the others, and how messages update it.

#include "viewer/protocol/cluster/clock_offset.h"
#include "viewer/protocol/cluster/cluster.h"
#include "viewer/protocol/cluster/messenger.h"
#include "viewer/protocol/cluster/process_watch.h"

#include <deque>
#include <functional>
#include <optional>

namespace viewer {

struct Cluster::State {
    /// A rank's message that it is ready to swap.
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
        bool there = false; ///< has sent hello; always true for the leader
        bool lost = false;
        bool said_goodbye = false;
        double heard_s = 0; ///< time of its last message, on the clock listened_s
        RoundTripClockOffset clock;
        std::optional<Arrival> arrival;
        std::string note;     ///< sent with the arrival
        std::string how_lost; ///< if it is
        std::string farewell; ///< sent with the goodbye
        std::deque<std::vector<std::uint8_t>> data;
        std::optional<double> awaited_s; ///< since when, on the clock listened_s; by watch()
    };

    State(ClusterIdentity identity, ClusterSettings settings);
    void start();

    /// Sends and receives messages, processes them, and detects processes that have ended. Throws RankLoss.
    void pump();
    /// Waits until the condition holds. Throws RankLoss if a rank selected by `waits_for` is lost, unless the
    /// others continue without it.
    void await(std::function<bool()> const& condition, std::function<bool(int)> const& waits_for, double silence_s,
               std::string const& what_for);

    /// @param from_s  when it was first waited for, on the clock listened_s
    void lose_if_silent(int rank, double from_s, double silence_s, std::string const& what_for);

    void send(int to, Writer message);
    void send_to_others(Writer const& message);
    void lose(int rank, std::string const& how);
    /// Throws RankLoss.
    [[noreturn]] void stop(std::string const& why);
    void note_order(std::span<std::uint8_t const> bytes);
    void tell_swap(Writer& message);
    Writer goodbye();
    std::string name(int rank) const;
    bool leads() const { return rank == 0; }
    /// True for another rank that is not lost.
    bool living(int r) const { return r != rank && !peers[std::size_t(r)].lost; }
    bool is_missing(int r) const { return living(r) && !peers[std::size_t(r)].arrival; } ///< before a swap
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
    std::function<std::string()> farewell;
    int rank = 0, size = 1;
    std::unique_ptr<Messenger> messenger; ///< none without other ranks
    ProcessId here;
    std::vector<Peer> peers; ///< all ranks, including this one
    std::vector<ClusterIdentity> identities;
    std::uint64_t orders_check = 0;
    std::deque<std::vector<std::uint8_t>> commands; ///< received but not yet fetched
    std::vector<Heard> heard;                       ///< received but not yet fetched
    std::optional<std::uint64_t> gone;              ///< frame of the last `go`
    Echo last_go;                                   ///< to be answered by a follower
    int pongs = 0, wants = 0;
    bool is_started = false, is_ended = false, over = false;
    bool is_leaving = false; ///< follower: has sent goodbye
    Swap swap;               ///< of this rank, not sent yet
    SwapLog swaps;
    std::vector<std::string> news;
    std::string broken; ///< why the cluster has ended; empty if it has not
    double watched_s = 0, lived_s = 0, pumped_s = 0;
    double listened_s = 0; ///< total time spent listening; stands still while this process is stopped or renders
};

} // namespace viewer
