#pragma once
// One of several processes that render together. Without several processes by mpirun, nothing here has an effect.

#include "gi/core/progress.h"
#include "gi/core/report.h"
#include "gi/render/render_settings.h"
#include "viewer/protocol/cluster/cluster.h"

#include <nlohmann/json.hpp>
#include <optional>

namespace viewer {

/// Thrown if a rank was interrupted by Ctrl-C; the others have been notified.
struct RankInterrupted {};

class RankWork {
public:
    /// Starts sending signs of life to the other ranks. Cluster and stop request must outlive this object.
    RankWork(Cluster& cluster, gi::StopRequest& stop);

    bool alone() const { return cluster_.alone(); }
    bool leads() const { return cluster_.leads(); }
    int rank() const { return cluster_.rank(); }
    int size() const { return cluster_.size(); }
    /// Stop request for rendering; also set if this rank has to stop because another one is lost.
    gi::StopRequest& stop() { return stop_; }

    /// Calls `what` to exchange messages with other ranks. Throws RankLoss; RankInterrupted after a stop request.
    void talk(std::function<void(Cluster&)> const& what);

    /// The paths per pixel that this rank traces, as a range of path numbers; one process alone traces all.
    /// PathShare::merge sends this rank's pixel sums to the leader, which adds them in the order of ranks.
    /// @param paths  per pixel, of all ranks together
    gi::PathShare share(std::uint32_t paths);
    /// Call after rendering: sends the other counts of all ranks to the leader.
    /// @param loaded  losses of the report before path tracing, which every rank has
    void gather(gi::RenderResult& result, gi::Report& report,
                std::map<std::string, gi::Report::Loss> const& loaded);
    /// Call when the leader has finished its work: from then on it ignores lost ranks.
    void finish();

private:
    void stay_alive();
    void merge(gi::Accumulator& sums);

    Cluster& cluster_;
    gi::StopRequest& stop_;
    std::uint32_t missing_paths_ = 0, paths_ = 0;
    bool needs_others_ = true; ///< false once the leader has what they contribute
    std::optional<KeepAlive> alive_;
};

/// Convert losses to and from messages between ranks.
nlohmann::json losses_json(std::map<std::string, gi::Report::Loss> const& losses);
std::map<std::string, gi::Report::Loss> losses_of(nlohmann::json const& json);
/// Adds the losses of another rank in loading the same scene, if they differ from those of this rank.
void add_other_losses(gi::Report& to, std::map<std::string, gi::Report::Loss> const& mine,
                      std::map<std::string, gi::Report::Loss> const& theirs, std::string const& name);

} // namespace viewer
