#pragma once
// What a table of pictures says in short: every method against its peer, row by row, the worst first.

#include "viewer/report/equal_error.h"
#include "viewer/report/table.h"

namespace viewer {

inline constexpr double kLostRatio =
    1.02; ///< of errors; a method with more error than this times the peer's loses

/// A method's picture against the peer's of the same scene, budget and filter.
struct PictureContest {
    std::string scene, budget, filter, method;
    double relmse_ratio = 0, flip_ratio = 0; ///< method / peer
    double time_ratio = 0;                   ///< of whole times; no method can take less than one path takes
    double relmse_time_factor = 0;           ///< how many times longer the peer needs for the same relMSE
    double flip_time_factor = 0;             ///< and for the same FLIP
    Reached relmse_reached = Reached::never, flip_reached = Reached::never;

    double worst() const;
    bool lost() const { return worst() > kLostRatio; }
};

/// @param pictures  a table with the columns scene, budget, method, filter, total_s, relmse and flip
/// @return worst first; empty where the peer is not among the methods
std::vector<PictureContest> contests(BenchTable const& pictures, std::string const& peer);

struct LostRows {
    std::string method;
    int rows = 0, relmse = 0, flip = 0, either = 0;
};
/// One per method, in order of appearance.
std::vector<LostRows> lost_rows(std::vector<PictureContest> const& contests);

/// As facts of the table.
void add_lost_rows(std::vector<PictureContest> const& contests, std::string const& peer, BenchTable& table);

/// @param table  empty, with columns of picture_summary_columns(); lost rows become facts
std::vector<std::string> picture_summary_columns(std::string const& peer);
void fill_picture_summary(std::vector<PictureContest> const& contests, std::string const& peer, BenchTable& table);

} // namespace viewer
