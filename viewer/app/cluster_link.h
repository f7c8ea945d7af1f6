#pragma once
#include "viewer/engine/live/live_renderer.h"
#include "viewer/protocol/cluster/cluster.h"

#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>

namespace viewer {

/// FrameLink between the ranks of mpirun. A thread of its own talks to the other ranks, so that light comes at its own
/// rate while pictures are shown in lock step; lost ranks are reported by name.
class ClusterLink : public FrameLink {
public:
    /// @param farewell  message from a follower to the leader at the end; called on any thread
    ClusterLink(ClusterIdentity identity, ClusterSettings const& settings,
                std::function<std::string()> farewell = {})
        : identity_(std::move(identity)), settings_(settings), farewell_(std::move(farewell))
    {
    }
    ~ClusterLink() override;
    void begin() override;
    void end() override;
    bool leads() const override { return leads_; }
    void send(FrameCommand const& command) override;
    std::optional<FrameCommand> receive() override;
    void check() override;
    FrameLight exchange(FrameCommand const& command, FrameLight own) override;
    FrameWork wait_for_all(FrameCommand const& command, FrameWork const& own) override;
    std::uint64_t show(ShownMoment moment) override;
    std::optional<ShownMoment> next_shown() override;
    void wake_by(std::function<void()> wake) override;
    void drawn(std::uint64_t number, ShownState own) override;
    void swapped(std::uint64_t number, double steady_s) override;
    ShownState shown_state() const override;

    /// Swap skew, on the leader, valid after the end. failure(): why the link ended early; empty if it did not.
    SwapSkew const& skew() const { return skew_; }
    std::string const& failure() const { return failure_; }
    /// How the other ranks ended, on the leader, valid after the end.
    std::vector<RankEnd> const& ends() const { return ends_; }

private:
    using Bytes = std::vector<std::uint8_t>;
    /// What other ranks said of a frame.
    struct Told {
        std::map<int, Bytes> light;
        std::map<int, FrameWork> work; ///< of those that can show it
    };
    /// What is shown now.
    struct Showing {
        std::uint64_t number = 0, drawn = 0, released = 0; ///< drawn, released: the last that was
        std::uint64_t state = 0;                           ///< of the orders until then
        bool is_announced = false;                         ///< leader: is sent; follower: is ready to swap
        ShownState own;
        double since_s = 0;
    };
    void run();
    bool talk(Cluster& cluster);
    bool step(Cluster& cluster);
    bool send_all(Cluster& cluster);
    bool take_orders(Cluster& cluster);
    bool take_messages(Cluster& cluster);
    bool swap_together(Cluster& cluster);
    std::string awaits(int rank) const;
    bool others_all(std::function<bool(int)> const& condition) const;
    void wait_until(std::unique_lock<std::mutex>& lock, std::function<bool()> const& condition);

    ClusterIdentity identity_;
    ClusterSettings settings_;
    std::function<std::string()> farewell_;
    std::vector<RankEnd> ends_;
    SwapSkew skew_;
    std::string failure_;

    mutable std::mutex mutex_; ///< of what follows
    std::condition_variable changed_, work_;
    bool has_begun_ = false, wants_end_ = false, leaves_ = false, is_over_ = false, is_ended_ = false;
    ShownState all_shown_;
    bool leads_ = false; ///< constant once it has begun
    int rank_ = 0;
    std::exception_ptr error_;
    std::vector<char> is_lost_;                         ///< ranks
    std::deque<Bytes> orders_;                          ///< to send
    std::deque<std::pair<int, Bytes>> messages_;        ///< to send; -1 = to all
    std::deque<FrameCommand> commands_;                 ///< received
    std::map<std::uint64_t, Told> told_;                ///< of frames that are not finished
    std::optional<std::uint64_t> light_of_, waits_for_; ///< frames that the rendering thread waits for
    Showing showing_;
    std::optional<ShownMoment> next_shown_;
    std::function<void()> wake_;
    std::vector<std::pair<std::uint64_t, double>> swaps_;
    std::thread thread_; ///< owns the Cluster
};

} // namespace viewer
