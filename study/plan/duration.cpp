#include "study/plan/duration.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace study {
namespace {

std::int64_t from_ms(double ms) { return std::llround(ms * 1000); }

} // namespace

std::int64_t reading_us(std::string const& text)
{
    if (is_text_file(text)) return 60000000;
    std::istringstream in(text);
    std::int64_t words = 0;
    for (std::string word; in >> word;) ++words;
    return std::max<std::int64_t>(10000000, words * 300000);
}

std::int64_t questionnaire_us(Questionnaire const& questionnaire)
{
    std::int64_t us = 0;
    for (QuestionnaireItem const& item : questionnaire.items)
        us += item.type == ItemType::text ? 20000000 : 6000000;
    return us;
}

std::int64_t until_onset_us(Script const& script, Block const& block)
{
    return from_ms(block.timing.iti_ms) +
           std::llround(1e6 * block.timing.warmup_frames / script.timing.expected_hz);
}

std::int64_t trial_us(Script const& script, Block const& block, Trial const& trial)
{
    std::int64_t const before = until_onset_us(script, block);
    if (block.task == Task::questionnaire)
        return before + questionnaire_us(script.questionnaires[std::size_t(block.questionnaire)]);
    if (block.task == Task::free_walk) return before + from_ms(1000 * block.duration_s);
    TrialTiming const& t = block.timing;
    std::int64_t const shown = std::int64_t(trial.order.size()) + (trial.reference ? 1 : 0);
    std::int64_t const intervals = block.is_sequential ? shown : 1;
    std::int64_t const stimuli =
        t.stimulus_ms ? intervals * from_ms(*t.stimulus_ms) + (intervals - 1) * from_ms(t.isi_ms) : 0;
    double const items = block.task == Task::ranking ? double(trial.order.size()) : 1;
    double response = t.expected_response_ms.value_or(items * facts(block.task).response_ms);
    if (t.timeout_ms) response = std::min(response, *t.timeout_ms);
    bool const has_feedback = trial.phase == Phase::practice ? block.practice.has_feedback : block.has_feedback;
    return before + stimuli + from_ms(response) + (has_feedback ? from_ms(t.feedback_ms) : 0);
}

} // namespace study
