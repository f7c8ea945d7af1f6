#pragma once
// Which observers of paired comparisons answer unlike all others: the analysis of pwcmp (Perez-Ortiz & Mantiuk
// 2017, arXiv:1712.03686, section 9). L of an observer is the mean log-likelihood of what he or she chose, over
// all pairs and scenes, under the scales of all the others (one per scene, with pwcmp's distance prior; by
// fit_pairs where that has no finite maximum). The score is how far L lies below the lower quartile, in
// interquartile ranges. The authors look at observers near or above 1.5, and advise to look before leaving anybody
// out.

#include "study/stats/matrix.h"

namespace study {

struct ObserverFit {
    double log_likelihood = 0; ///< L; NaN for somebody who saw nothing, whose score is 0
    double outlier_score = 0;  ///< (q25 - L) / (q75 - q25) where L < q25, else 0
};

/// @param wins  per scene, per observer: how often i was chosen over j; zeros where one saw nothing
/// @throws std::invalid_argument fewer than 3 observers with answers; scenes of different observers or items; as
/// fit_pairs for the others of somebody
std::vector<ObserverFit> observer_outliers(std::vector<std::vector<Matrix>> const& wins);

} // namespace study
