#pragma once
// Expected durations in microseconds; integers, so that sums are equal on all machines.

#include "study/plan/plan.h"

namespace study {

/// Reading at 200 words per minute, at least 10 s; 60 s for a file, whose text is unknown here.
std::int64_t reading_us(std::string const& text);
/// 6 s per item.
std::int64_t questionnaire_us(Questionnaire const& questionnaire);
/// Duration from the end of the previous trial: iti, warm-up, stimuli, answer, feedback.
std::int64_t trial_us(Script const& script, Block const& block, Trial const& trial);
/// Part of trial_us before the first stimulus.
std::int64_t until_onset_us(Script const& script, Block const& block);

/// `study plan` warns about longer sessions, because they are tiring.
inline constexpr std::int64_t kLongSession_us = 3600LL * 1000000;

} // namespace study
