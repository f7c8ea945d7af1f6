#pragma once
// How long things are expected to take, in microseconds: whole numbers, so that sums are the same everywhere.

#include "study/plan/plan.h"

namespace study {

/// Reading at 200 words a minute, at least 10 s; of a file, whose text is not known here, 60 s.
std::int64_t reading_us(std::string const& text);
/// 6 s an item.
std::int64_t questionnaire_us(Questionnaire const& questionnaire);
/// From the end of the trial before: iti, warm-up, stimuli, answer, feedback.
std::int64_t trial_us(Script const& script, Block const& block, Trial const& trial);
/// What of it passes before the first stimulus.
std::int64_t until_onset_us(Script const& script, Block const& block);

/// Longer sessions tire: `study plan` warns.
inline constexpr std::int64_t kLongSession_us = 3600LL * 1000000;

} // namespace study
