#pragma once
// `lightwell bench pictures`: methods judged by their pictures, over scenes, budgets and filters.

#include "viewer/bench/table.h"
#include "viewer/render_options.h"

namespace viewer {

inline constexpr char const* kPeer = "reference"; ///< the method that others are measured against

struct PicturesOptions {
    RenderOptions render; ///< what all renders have in common: size, bounces, first seed, threads, quality
    std::string list = "data/pictures.yaml";
    std::vector<std::string> scenes; ///< names in the list; empty = all
    std::vector<std::string> budgets{"1path", "100ms", "300ms", "1s", "4s"};
    std::vector<std::string> filters{"none", "atrous"};
    std::vector<std::string> methods{kPeer, "slhb", "vpl_slhb"};
    std::uint32_t reference_paths = 4096;
    std::string references; ///< folder; empty = "references" within `out`
    int repeats = 3;
    bool resume = false; ///< rows that the folder has already are kept
    std::string out;
};

struct PicturesResult {
    BenchTable pictures, summary;
    bool interrupted = false; ///< the tables hold what was done before
};

/// Writes tables, pictures and the page to the folder as they come. What is wrong with the call is found before
/// anything is rendered (InputError); scenes and filters that are not available are skipped, said on stderr and
/// noted in the tables.
PicturesResult run_pictures(PicturesOptions const& options);

/// Of the rows in `pictures`: the contests of all methods with the peer, worst first.
BenchTable summary_of(BenchTable const& pictures);

} // namespace viewer
