#pragma once
// Summary of a table of pictures: every method against the peer method, row by row, worst first.

#include "viewer/report/equal_error.h"
#include "viewer/report/table.h"

namespace viewer {

inline constexpr double kLostRatio = 1.02; ///< a method loses if its error exceeds this times that of the peer

/// Comparison of a method's picture with the peer's for the same scene, budget and filter.
struct PictureContest {
    std::string scene, budget, filter, method;
    double relmse_ratio = 0, flip_ratio = 0; ///< method / peer
    double time_ratio = 0;                   ///< method / peer, of whole times; at least one path is traced
    double relmse_time_factor = 0;           ///< time of the peer for the same relMSE / time of the method
    double flip_time_factor = 0;             ///< the same for FLIP
    Reached relmse_reached = Reached::never, flip_reached = Reached::never;

    double worst() const;
    bool lost() const { return worst() > kLostRatio; }
};

/// @param pictures  a table with the columns scene, budget, method, filter, total_s, relmse and flip
/// @return comparisons, worst first; empty if the peer is not among the methods
std::vector<PictureContest> contests(BenchTable const& pictures, std::string const& peer);

struct LostRows {
    std::string method;
    int rows = 0, relmse = 0, flip = 0, either = 0;
};
/// One per method, in order of appearance.
std::vector<LostRows> lost_rows(std::vector<PictureContest> const& contests);

/// Adds the lost rows as facts of the table.
void add_lost_rows(std::vector<PictureContest> const& contests, std::string const& peer, BenchTable& table);

/// @param table  empty, with the columns of picture_summary_columns(); lost rows are added as facts
std::vector<std::string> picture_summary_columns(std::string const& peer);
void fill_picture_summary(std::vector<PictureContest> const& contests, std::string const& peer, BenchTable& table);

} // namespace viewer
