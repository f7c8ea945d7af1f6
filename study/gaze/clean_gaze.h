#pragma once
// Samples of gaze as an analysis can use them: in the order of their times, with finite places near the screen.

#include "study/signals/gaze.h"

#include <array>

namespace study {

/// What was counted while samples were read and cleaned.
struct GazeCounts {
    int samples = 0;    ///< as recorded, of each eye
    int unreadable = 0; ///< rows that are no samples; left out
    int no_time = 0;    ///< left out
    int repeated = 0;   ///< with the time of the one before; left out
    int backwards = 0;  ///< earlier than one before: the clock jumped back; left out
    int not_finite = 0; ///< said to be valid, without a finite place; lost
    int far_off = 0;    ///< more than a screen's size beyond its edge, as values for lost samples are; lost
    int one_eyed = 0;   ///< one eye of two was found; lost, as a change of eyes looks like a saccade
    int unpaired = 0;   ///< of one eye, without a sample of the other at the same time; lost
    GazeCounts& operator+=(GazeCounts const& other);
};
/// Its numbers with names and meanings, for tables.
struct NamedCount {
    char const *name, *meaning;
    int GazeCounts::*count;
};
inline constexpr std::array kGazeCounts{
    NamedCount{"samples", "samples as recorded, of each eye", &GazeCounts::samples},
    NamedCount{"unreadable", "rows that are no samples; left out", &GazeCounts::unreadable},
    NamedCount{"no_time", "samples without a time; left out", &GazeCounts::no_time},
    NamedCount{"repeated", "samples with the time of the one before; left out", &GazeCounts::repeated},
    NamedCount{"backwards", "samples earlier than one before, as the clock jumped back; left out",
               &GazeCounts::backwards},
    NamedCount{"not_finite", "samples said to be valid, without a finite place; lost", &GazeCounts::not_finite},
    NamedCount{"far_off", "samples more than a screen's size beyond its edge; lost", &GazeCounts::far_off},
    NamedCount{"one_eyed", "samples with one eye of two; lost", &GazeCounts::one_eyed},
    NamedCount{"unpaired", "samples of one eye without one of the other at the same time; lost",
               &GazeCounts::unpaired}};

/// Leaves out samples whose times do not rise; those without a usable place become invalid. All are added to the
/// counts, `samples` excepted.
/// @param samples  places in px from the screen's centre   @param screen  with a distance
std::vector<GazeSample> clean_gaze(std::vector<GazeSample> const& samples, ScreenGeometry const& screen,
                                   GazeCounts& counts);

/// Mean of two eyes where both are valid. Samples belong together if their times differ by at most half a step.
/// @param left, right  cleaned
std::vector<GazeSample> mean_of_eyes(std::vector<GazeSample> const& left, std::vector<GazeSample> const& right,
                                     GazeCounts& counts);

/// Median time between samples, s; NaN with fewer than two.
double median_step_s(std::vector<GazeSample> const& samples);

} // namespace study
