#include "study/observers/model_presenter.h"

#include "study/observers/answer.h"
#include "study/plan/duration.h"
#include "study/run/settings_hash.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

/// Number of the random stream of a step and attempt; attempts are fewer than 1000.
std::uint64_t purpose(int step, int attempt) { return std::uint64_t(step) * 1000 + std::uint64_t(attempt); }
constexpr std::uint64_t kItems = std::uint64_t(1) << 40;

double seconds(std::int64_t us) { return double(us) * 1e-6; }

} // namespace

std::vector<std::pair<std::string, std::string>> ModelPresenter::about() const
{
    return {{"device", "model observer"}, {"display", fmt::format("simulated, {:g} Hz", observer_.model.hz)}};
}

CalibrationDone ModelPresenter::calibrate(Timing const& timing)
{
    CalibrationDone c;
    c.frames = timing.calibrate.frames;
    c.nominal_hz = observer_.model.hz;
    c.period_mean_ms = 1000 / observer_.model.hz;
    c.period_sd_ms = observer_.model.period_sd_ms;
    c.onset_method = "simulated";
    c.passed = c.period_sd_ms <= timing.calibrate.max_sd_ms;
    if (!c.passed)
        c.reason = fmt::format("the frame period has a standard deviation of {:g} ms, at most {:g} ms are allowed",
                               c.period_sd_ms, timing.calibrate.max_sd_ms);
    now_s_ += c.frames / observer_.model.hz;
    return c;
}

bool ModelPresenter::ask_consent(std::string const& markdown)
{
    now_s_ += seconds(reading_us(markdown));
    return true;
}

ParticipantAsked ModelPresenter::ask_participant(std::vector<AskedQuestion> const& questions)
{
    ParticipantAsked asked;
    for (AskedQuestion const& q : questions) {
        std::string answer = "simulated";
        if (q.type == AskedType::number) answer = fmt::format("{:g}", q.is_whole ? std::ceil(q.low) : q.low);
        if (q.type == AskedType::choice) answer = q.choices.front();
        asked.answers.emplace_back(q.id, answer);
    }
    now_s_ += 5.0 * double(questions.size());
    return asked;
}

StepDone ModelPresenter::take(int step, double duration_s)
{
    double const start_s = now_s_;
    now_s_ += duration_s;
    return {step, start_s, now_s_, ""};
}

StepDone ModelPresenter::instruct(std::string const& markdown, int step)
{
    return take(step, seconds(reading_us(markdown)));
}

StepDone ModelPresenter::rest(std::string const&, double least_s, int step) { return take(step, least_s); }

StepDone ModelPresenter::walk(TrialRequest const& where, std::string const&, double duration_s)
{
    return take(where.step_index, duration_s);
}

QuestionnaireDone ModelPresenter::ask(QuestionnaireRequest const& r)
{
    Random random = observer_.random(kItems + std::uint64_t(r.step));
    StepDone const taken = take(r.step, seconds(questionnaire_us(*r.questionnaire)));
    QuestionnaireDone done{r.step, taken.start_s, taken.end_s, {}};
    answer_items(observer_, *r.questionnaire, random, done);
    return done;
}

void ModelPresenter::show_stimuli(TrialRequest const& r, double reaction_s, Random& random, TrialDone& done)
{
    TrialTiming const& timing = r.block->timing;
    double const hz = observer_.model.hz;
    std::string letters = r.step->trial.order;
    if (r.reference) letters = "r" + letters;
    double const shown_s = timing.stimulus_ms ? *timing.stimulus_ms * 1e-3 : reaction_s;
    int const frames = std::max(1, int(std::lround(shown_s * hz)));
    int const bad =
        random.uniform() < observer_.model.dropped ? int(random.below(std::uint32_t(letters.size()))) : -1;
    for (std::size_t i = 0; i < letters.size(); ++i) {
        Stimulus const& stimulus =
            letters[i] == 'r' && r.reference ? *r.reference : r.stimuli[std::size_t(letters[i] - 'a')];
        StimulusShown s;
        s.letter = letters[i];
        if (r.block->is_sequential && i > 0)
            now_s_ = done.shown.back().onset_s + frames / hz + timing.isi_ms * 1e-3;
        s.onset_s = std::ceil(now_s_ * hz) / hz;
        s.duration_s = frames / hz;
        s.onset_method = "simulated";
        s.frames_planned = frames;
        s.frames_dropped = int(i) == bad ? 1 + int(random.below(3)) : 0;
        s.frames_shown = std::max(0, frames - s.frames_dropped);
        s.render_ms_mean = observer_.render_ms(stimulus.levels) * (1 + 0.02 * random.normal());
        s.render_ms_p99 = 1.15 * s.render_ms_mean;
        s.settings_sha256 = settings_hash(settings_of(*r.script, *r.block, stimulus));
        done.shown.push_back(std::move(s));
    }
}

/// Without error: the display's clock is the sounds'. @param start_s of the trial, when the fixation is due
void ModelPresenter::play_cues(TrialRequest const& r, double start_s, TrialDone& done) const
{
    std::vector<std::pair<std::string, double>> moments{{"fixation", start_s}}; // in order
    for (StimulusShown const& s : done.shown)
        if (moments.size() > 1 && moments.back().second == s.onset_s)
            moments.back().first += s.letter; // shown together
        else
            moments.emplace_back(std::string(1, s.letter), s.onset_s);
    for (std::size_t i = 0; i < moments.size(); ++i)
        for (Cue const& c : r.block->cues) {
            bool const is_due =
                i == 0 ? c.at == CueMoment::fixation
                       : c.at == CueMoment::each_stimulus || (i == 1 && c.at == CueMoment::first_stimulus);
            if (!is_due) continue;
            Sound const& sound = r.script->sounds[std::size_t(c.sound)];
            SoundPlayed p;
            p.sound = sound.name;
            p.at = moments[i].first;
            p.event_s = moments[i].second;
            p.offset_ms = c.offset_ms;
            p.onset_s = p.event_s + 1e-3 * c.offset_ms;
            p.duration_s = sound.file.empty() ? 1e-3 * sound.duration_ms : 0; // files are not read
            done.sounds.push_back(std::move(p));
        }
}

TrialDone ModelPresenter::show(TrialRequest const& r)
{
    TrialTiming const& timing = r.block->timing;
    Random random = observer_.random(purpose(r.step_index, r.attempt));
    TrialDone done;
    double const start_s = now_s_;
    now_s_ += timing.iti_ms * 1e-3 + timing.warmup_frames / observer_.model.hz;
    double const reaction_s =
        1e-3 * observer_.model.reaction_ms * std::exp(observer_.model.reaction_sd * random.normal());
    show_stimuli(r, reaction_s, random, done);
    play_cues(r, start_s, done);
    StimulusShown const& last = done.shown.back();
    bool const is_late = timing.timeout_ms &&
                         (reaction_s > *timing.timeout_ms * 1e-3 || random.uniform() < observer_.model.timeout);
    if (is_late) {
        done.is_valid = false;
        done.reason = "timeout";
        now_s_ = std::max(last.onset_s + last.duration_s, last.onset_s + *timing.timeout_ms * 1e-3);
    } else {
        ModelAnswer const a = answer(observer_, r, random);
        done.response = a.response;
        done.value = a.value;
        done.response_s = last.onset_s + reaction_s;
        done.reaction_ms = reaction_s * 1e3;
        done.device = "model";
        now_s_ = std::max(last.onset_s + last.duration_s, *done.response_s);
    }
    bool const is_practice = r.step->trial.phase == Phase::practice;
    if (is_practice ? r.block->practice.has_feedback : r.block->has_feedback) now_s_ += timing.feedback_ms * 1e-3;
    return done;
}

} // namespace study
