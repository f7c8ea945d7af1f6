#pragma once
// Options of the commands that mpirun can start as several processes.

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
/// Throws InputError on invalid options.
ClusterSettings cluster_settings(RankOptions const& options);

} // namespace viewer
