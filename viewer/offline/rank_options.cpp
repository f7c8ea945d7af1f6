#include "viewer/offline/rank_options.h"

#include "viewer/base/validators.h"
#include "viewer/protocol/cluster/cluster.h"

#include <CLI/CLI.hpp>

namespace viewer {

void declare_rank_options(CLI::App& c, RankOptions& o)
{
    constexpr char const* kGroup = "Several machines (mpirun, see docs/cluster.md)";
    c.add_option("--on-rank-loss", o.on_loss,
                 "if a process dies or stalls: stop all, or continue without it (mpirun --enable-recovery)")
        ->check(CLI::IsMember({"stop", "continue"}))
        ->capture_default_str()
        ->group(kGroup);
    c.add_option("--rank-silence", o.silence_s, "s without a message after which a process counts as lost")
        ->check(in_range(0.5, 3600))
        ->capture_default_str()
        ->group(kGroup);
}

ClusterSettings cluster_settings(RankOptions const& o)
{
    ClusterSettings s;
    s.on_loss = parse_on_rank_loss(o.on_loss);
    s.silence_s = o.silence_s;
    return s;
}

} // namespace viewer
