#pragma once
#include "viewer/engine/live/live_renderer.h"
#include "viewer/protocol/cluster/cluster.h"

#include <condition_variable>
#include <mutex>

namespace viewer {

/// FrameLink between the ranks of mpirun: frames in lock step; lost ranks are reported by name.
class ClusterLink : public FrameLink {
public:
    /// @param farewell  message from a follower to the leader at the end; called on any thread
    ClusterLink(ClusterIdentity identity, ClusterSettings const& settings,
                std::function<std::string()> farewell = {})
        : identity_(std::move(identity)), settings_(settings), farewell_(std::move(farewell))
    {
    }
    void begin() override;
    void end() override;
    bool leads() const override;
    void send(FrameCommand const& command) override;
    std::optional<FrameCommand> receive() override;
    void check() override;
    FrameWork wait_for_all(FrameCommand const& command, FrameWork const& own) override;
    void drawn(std::uint64_t frame) override;
    void swapped(std::uint64_t frame, double steady_s) override;

    /// Swap skew, on the leader, valid after the end. failure(): why the link ended early; empty if it did not.
    SwapSkew const& skew() const { return skew_; }
    std::string const& failure() const { return failure_; }
    /// How the other ranks ended, on the leader, valid after the end.
    std::vector<RankEnd> const& ends() const { return ends_; }

private:
    void report_swaps();
    template <class F>
    auto guarded(F const& call);

    ClusterIdentity identity_;
    ClusterSettings settings_;
    std::unique_ptr<Cluster> cluster_; ///< used by the rendering thread
    std::unique_ptr<KeepAlive> alive_; ///< keeps the link alive between calls, which may be far apart
    std::function<std::string()> farewell_;
    std::vector<RankEnd> ends_;
    SwapSkew skew_;
    std::string failure_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::uint64_t drawn_ = 0, released_ = 0; ///< frames, counted from 1
    std::vector<std::pair<std::uint64_t, double>> swaps_;
};

} // namespace viewer
