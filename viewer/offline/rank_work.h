#pragma once
// One of the processes that render together; where mpirun did not start several, nothing here does anything.

#include "gi/core/progress.h"
#include "gi/core/report.h"
#include "gi/render/render_settings.h"
#include "viewer/protocol/cluster/cluster.h"

#include <nlohmann/json.hpp>
#include <optional>

namespace viewer {

/// Ctrl-C came to a rank; the others have been told.
struct RankInterrupted {};

class RankWork {
public:
    /// From now on the others hear that this rank is at work. The cluster outlives this.
    explicit RankWork(Cluster& cluster);

    bool alone() const { return cluster_.alone(); }
    bool leads() const { return cluster_.leads(); }
    int rank() const { return cluster_.rank(); }
    int size() const { return cluster_.size(); }
    /// For all that renders: also asked for where this rank has to stop because another one is lost.
    gi::StopRequest& stop() { return stop_; }

    /// Talks to the others in between. Throws RankLoss; RankInterrupted where a stop was asked for.
    void talk(std::function<void(Cluster&)> const& what);

    /// The share of this rank of the paths of one picture; its merge gives all sums to the leader, who adds them
    /// in the order of ranks.
    gi::PathShare share(std::uint32_t paths);
    /// Afterwards: the leader gets what else the others counted.
    /// @param loaded  losses of the report before the paths; every rank has them
    void gather(gi::RenderResult& result, gi::Report& report,
                std::map<std::string, gi::Report::Loss> const& loaded);
    /// All that the leader had to do is done: no loss counts any more for it.
    void finish();

private:
    void stay_alive();
    void merge(gi::Accumulator& sums);

    Cluster& cluster_;
    gi::StopRequest stop_;
    std::uint32_t missing_paths_ = 0, paths_ = 0;
    std::optional<KeepAlive> alive_;
};

/// Losses for a message to another rank, and from one.
nlohmann::json losses_json(std::map<std::string, gi::Report::Loss> const& losses);
std::map<std::string, gi::Report::Loss> losses_of(nlohmann::json const& json);
/// What another rank lost while it loaded the same scene: nothing new, but where it differs.
void add_other_losses(gi::Report& to, std::map<std::string, gi::Report::Loss> const& mine,
                      std::map<std::string, gi::Report::Loss> const& theirs, std::string const& name);

} // namespace viewer
