#pragma once
// What the commands that mpirun can start several times have in common.

#include <string>

namespace CLI {
class App;
}

namespace viewer {

struct ClusterSettings;

struct RankOptions {
    std::string on_loss = "stop";
    double silence_s = 5;
};

void declare_rank_options(CLI::App& command, RankOptions& options);
/// Throws InputError.
ClusterSettings cluster_settings(RankOptions const& options);

} // namespace viewer
