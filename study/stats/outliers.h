#pragma once
// Outliers among observers of paired comparisons: the analysis of pwcmp (Perez-Ortiz & Mantiuk 2017,
// arXiv:1712.03686, section 9). L of an observer is the mean log-likelihood of the observer's choices over all
// pairs and scenes, under the scales of all other observers (one per scene, with pwcmp's distance prior; by
// fit_pairs if that has no finite maximum). The score is the distance of L below the lower quartile, in
// interquartile ranges. The authors inspect observers near or above 1.5, and advise inspection before exclusion.

#include "study/numeric/matrix.h"

namespace study {

struct ObserverFit {
    double log_likelihood = 0; ///< L; NaN for an observer without answers, whose score is 0
    double outlier_score = 0;  ///< (q25 - L) / (q75 - q25) if L < q25, else 0
};

/// @param wins  per scene, per observer: how often i was chosen over j; zeros if not seen
/// @throws std::invalid_argument fewer than 3 observers with answers; scenes with different observers or items; as
/// fit_pairs for the data of the other observers
std::vector<ObserverFit> observer_outliers(std::vector<std::vector<Matrix>> const& wins);

} // namespace study
