#include "viewer/experiment/trial.h"

#include "gi/core/quantile.h"
#include "study/run/trial.h"
#include "viewer/experiment/page.h"
#include "viewer/experiment/screens/refresh.h"
#include "viewer/experiment/stimuli/physical.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace viewer {
namespace {

constexpr int kGap_px = 16;
constexpr float kTextLines = 6.5f;  ///< lines of text below the pictures
constexpr double kRound_ms = 6000;  ///< one round of a path, if stimuli stay until the answer
constexpr double kAdjustSteps = 40; ///< steps over the whole range

/// Order of presentation, e.g. "ba"; a reference comes between the two of a pair, else before all others.
std::string presented(study::TrialRequest const& r)
{
    std::string order = r.step->trial.order;
    if (!r.reference) return order;
    order.insert(!r.block->is_sequential && order.size() == 2 ? 1 : 0, 1, 'r');
    return order;
}

double render_ms(LiveFrame const& f) { return 1e3 * (f.done_s - f.begun_s); }

} // namespace

std::vector<ScreenPane> panes_for(std::size_t count, glm::ivec2 screen_px, float text_px)
{
    std::vector<ScreenPane> panes(count);
    int const n = int(count), height = std::max(screen_px.y / 2, screen_px.y - int(text_px));
    int const width = std::max(1, (screen_px.x - kGap_px * (n - 1)) / std::max(1, n));
    for (int i = 0; i < n; ++i) {
        panes[std::size_t(i)].corner_px = {i * (width + kGap_px), 0};
        panes[std::size_t(i)].size_px = {width, height};
    }
    return panes;
}

StimulusView view_of(study::Block const& block, StimulusSettings const& stimulus, std::size_t together,
                     glm::ivec2 screen_px, float font_px, study::DisplayModel const* model)
{
    StimulusView view;
    ScreenPane const pane = panes_for(together, screen_px, kTextLines * font_px).front();
    view.size_px = placed_within(stimulus.physical, model, pane.corner_px, pane.size_px).size_px;
    view.stereo = *stereo_mode(stimulus.settings.stereo);
    view.duration_s = 1e-3 * block.timing.stimulus_ms.value_or(kRound_ms);
    view.warmup_frames = block.timing.warmup_frames;
    return view;
}

TrialPresenter::Trial::Trial(TrialPresenter& presenter, study::TrialRequest const& request)
    : p_(presenter),
      request_(request),
      block_(*request.block),
      order_(presented(request)),
      response_(block_, p_.keys_, request.step->trial.order),
      cues_(*request.script, block_, p_.options_.audio, p_.options_.sounds),
      level_(request.level)
{
    for (char const letter : order_) {
        if (std::any_of(known_.begin(), known_.end(), [&](LoadedStimulus const& k) { return k.letter == letter; }))
            continue;
        std::size_t const at = letter == 'r' ? request.stimuli.size() : std::size_t(letter - 'a');
        study::Stimulus const& stimulus = letter == 'r' ? *request.reference : request.stimuli.at(at);
        StimulusSettings settings = stimulus_settings(*request.script, block_, stimulus);
        StereoMode const stereo = *stereo_mode(settings.settings.stereo);
        StimulusSource& source = p_.source(known_.size(), block_.stimuli, settings);
        known_.push_back({letter, stimulus, std::move(settings), &source, stereo});
    }
}

void TrialPresenter::Trial::fill(ScreenPane& pane, LoadedStimulus const& k) const
{
    pane.frame = k.source->newest();
    pane.stereo = k.stereo;
    pane.light = k.light;
    if (pane.frame) pane.moment = k.source->moment(*pane.frame);
    pane.stimulus = std::size_t(&k - known_.data());
    PlacedPixels const placed = placed_within(k.settings.physical, p_.model(), pane.corner_px, pane.size_px);
    pane.corner_px = placed.corner_px;
    pane.size_px = placed.size_px;
}

ScreenContent TrialPresenter::Trial::content(std::string const& letters)
{
    ScreenContent c;
    glm::ivec2 const px = p_.screen_->size_px();
    c.panes = panes_for(letters.size(), px, kTextLines * p_.options_.screen.font_px);
    for (std::size_t i = 0; i < letters.size(); ++i)
        for (LoadedStimulus const& k : known_)
            if (k.letter == letters[i]) fill(c.panes[i], k);
    p_.add_patch(c, !letters.empty());
    if (!letters.empty() && block_.gaze.moving) c.gaze = p_.gaze_circle(*block_.gaze.moving);
    return c;
}

/// Handles input and the experimenter's actions while nothing is shown. Returns false if the trial is over.
bool TrialPresenter::Trial::wait(double until_s, bool cross)
{
    ScreenContent empty = content("");
    if (cross) empty.text = [](glm::vec2 px) { draw_cross(px); };
    p_.present(empty);
    do {
        p_.screen_->wait_until(Clock::now() + std::chrono::milliseconds(5));
        p_.between_frames();
        heed(p_.screen_->take_input());
        if (p_.should_end()) return false;
    } while (p_.now() < until_s);
    return true;
}

bool TrialPresenter::Trial::get_ready(LoadedStimulus& k)
{
    std::size_t const together = block_.is_sequential ? 1 : order_.size();
    StimulusView view =
        view_of(block_, k.settings, together, p_.screen_->size_px(), p_.options_.screen.font_px, p_.model());
    view.on_walls = p_.on_walls();
    k.source->prepare(k.settings, view);
    while (!k.source->is_ready())
        if (!wait(0, block_.is_sequential)) return false;
    calibrate_light(k, true);
    k.source->rest();
    return true;
}

/// If its surfaces will be drawn: now, unseen, so that they can be from its onset on.
void TrialPresenter::Trial::draw_ahead(LoadedStimulus const& k)
{
    std::size_t const together = block_.is_sequential ? 1 : order_.size();
    ScreenPane pane = panes_for(together, p_.screen_->size_px(), kTextLines * p_.options_.screen.font_px).front();
    fill(pane, k);
    if (pane.moment) p_.screen_->make_ready(pane);
}

/// Prepares one stimulus after the other, so that each can use the whole machine.
bool TrialPresenter::Trial::get_all_ready()
{
    for (LoadedStimulus& k : known_)
        if (!get_ready(k)) return false;
    for (std::size_t k = known_.size(); k > 0; --k) draw_ahead(known_[k - 1]); // the first one last
    double const lead_s = cues_.lead_s(study::CueMoment::each_stimulus, true);
    return wait(p_.trial_end_s_ + 1e-3 * block_.timing.iti_ms - lead_s, block_.is_sequential);
}

/// Waits before the next stimulus. Prepares it again if it moves and was shown before.
bool TrialPresenter::Trial::wait_between(std::size_t next)
{
    double const until_s = p_.now() + 1e-3 * block_.timing.isi_ms;
    for (LoadedStimulus& k : known_)
        if (k.letter == order_[next] && order_.find(k.letter) < next && k.source->moves() && !get_ready(k))
            return false;
    for (LoadedStimulus const& k : known_)
        if (k.letter == order_[next]) draw_ahead(k);
    return wait(until_s - cues_.lead_s(study::CueMoment::each_stimulus), true);
}

bool TrialPresenter::Trial::has_ended()
{
    if (p_.should_end() || !gaze_failure_.empty()) return true;
    return is_answered_ || (block_.timing.timeout_ms && p_.now() > onset_s_ + 1e-3 * *block_.timing.timeout_ms);
}

/// Handles events that are not answers. Returns true if one of them was for the program.
bool TrialPresenter::Trial::heed(std::vector<InputEvent> const& events)
{
    bool was_any = false;
    for (InputEvent const& e : events) {
        was_any |= p_.heed_window(e);
        is_lost_ |= e.kind == InputKind::focus && e.action == InputAction::release;
    }
    return was_any;
}

void TrialPresenter::Trial::take_answers()
{
    for (InputEvent const& e : p_.screen_->take_input()) {
        if (heed({e}) || is_answered_ || p_.seconds(e.time) < onset_s_) continue;
        is_answered_ = response_.take(e);
    }
    adjust();
}

/// Applies adjustment steps to the level; the change is shown as soon as it is rendered.
void TrialPresenter::Trial::adjust()
{
    int const steps = response_.take_steps();
    if (steps == 0 || !block_.compare || !level_) return;
    study::Compare const& c = *block_.compare;
    double const low = to_scale(c.scale, c.low), high = to_scale(c.scale, c.high);
    double const moved = to_scale(c.scale, *level_) + steps * (high - low) / kAdjustSteps;
    level_ = study::from_scale(c.scale, std::clamp(moved, low, high));
    for (LoadedStimulus& k : known_) {
        if (!k.stimulus.is_varied) continue;
        k.stimulus.level = level_;
        PhysicalStimulus const before = k.settings.physical;
        k.settings = stimulus_settings(*request_.script, block_, k.stimulus);
        if (k.settings.physical != before) calibrate_light(k, false); // otherwise as of the first picture
        k.source->change(k.settings);
    }
}

void TrialPresenter::Trial::add_rows(std::string const& letters, ScreenSwap const& swap, int dropped,
                                     ScreenContent const& c)
{
    FrameRow row;
    row.step = request_.step_index;
    row.attempt = request_.attempt;
    row.shown = letters.empty() ? "-" : letters;
    row.swap_s = p_.seconds(swap.time);
    row.uncertainty_ms = swap.uncertainty_ms;
    row.method = swap.method;
    row.dropped = dropped;
    for (ScreenPane const& pane : c.panes)
        if (pane.frame) row.render_ms = std::max(row.render_ms, render_ms(*pane.frame));
    if (block_.stimuli == study::Stimuli::live && !c.panes.empty() && c.panes[0].frame)
        p_.keep_pose(row.swap_s, views_of(c.panes[0]));
    p_.table_.add(std::move(row));
}

void TrialPresenter::Trial::appear(std::string const& letters, bool takes_answer)
{
    bool const stays = !block_.timing.stimulus_ms && takes_answer;
    double const length_s = 1e-3 * block_.timing.stimulus_ms.value_or(0);
    std::vector<LoadedStimulus*> seen;
    for (LoadedStimulus& k : known_)
        if (letters.find(k.letter) != std::string::npos) seen.push_back(&k);
    for (LoadedStimulus* const k : seen) k->source->at(0);
    heed(p_.screen_->take_input());                       // earlier key presses are not answers
    std::vector<std::shared_ptr<LiveFrame const>> frames; // frames that were shown
    std::vector<double> render;
    auto const note_frames = [&](ScreenContent const& c) {
        for (ScreenPane const& pane : c.panes)
            if (pane.frame && std::find(frames.begin(), frames.end(), pane.frame) == frames.end()) {
                frames.push_back(pane.frame);
                render.push_back(render_ms(*pane.frame));
                if (frames.size() > 8) frames.erase(frames.begin());
            }
    };
    std::optional<study::GazeWatch> hold;
    if (block_.gaze.hold) {
        hold.emplace(p_.gaze_screen(), std::pair{0.0, 0.0}, block_.gaze.hold->within_deg);
        p_.gaze_.watch(&*hold);
    }
    p_.gaze_.at(request_.step_index, letters);
    p_.gaze_.begin_capture();
    start_cues(study::CueMoment::each_stimulus, letters);
    ScreenContent c = content(letters);
    if (stays) c.text = [this](glm::vec2 px) { response_.draw(px); };
    ScreenSwap swap = p_.present(c);
    ScreenSwap const onset = swap;
    std::vector<int> drawn(letters.size());
    auto const note_drawn = [&] {
        for (std::size_t k = 0; k < std::min(drawn.size(), swap.drawn.size()); ++k) drawn[k] += swap.drawn[k];
        for (LoadedStimulus* const k : seen) k->source->drawn_at(swap.drawn_scale);
    };
    note_drawn();
    onset_s_ = p_.seconds(onset.time);
    cues_.came(onset_s_);
    onset_uncertainty_ms_ = onset.uncertainty_ms;
    p_.screen_->take_longest_look_ms();
    mark(onset_s_, "stimulus",
         {{"shown", letters},
          {"stimuli", labels(letters)},
          {"onset_method", onset.method},
          {"onset_uncertainty_ms", onset.uncertainty_ms}});
    add_rows(letters, swap, 0, c);
    note_frames(c);
    std::vector<ScreenPane> const c_shown = c.panes;
    int shown = 1, dropped = 0;
    double const first_s = p_.seconds(onset.seen);
    double last_s = first_s;
    while (!p_.should_end()) {
        if (hold && hold->away_ms() > block_.gaze.hold->grace_ms) {
            gaze_failure_ = "gaze_left";
            break;
        }
        if (!stays && last_s + p_.period_s_ > first_s + length_s - 0.5 * p_.period_s_) break;
        if (takes_answer) {
            take_answers();
            if (stays && has_ended()) break;
        }
        for (LoadedStimulus* const k : seen) k->source->at(p_.now() - onset_s_);
        c = content(letters);
        int clicked = -1;
        if (stays) c.text = [&](glm::vec2 px) { clicked = response_.draw(px); };
        swap = p_.present(c);
        if (clicked >= 0 && response_.click(clicked)) is_answered_ = true;
        double const at_s = p_.seconds(swap.seen);
        int const lost = dropped_between(at_s - last_s, p_.period_s_);
        dropped += lost;
        ++shown;
        last_s = at_s;
        add_rows(letters, swap, lost, c);
        note_frames(c);
        note_drawn();
    }
    c = content("");
    swap = p_.present(c);
    double const end_s = p_.seconds(swap.time);
    p_.gaze_.poll(p_.screen_->gaze_place(), p_.now());
    gaze_seen_.emplace_back();
    for (study::GazeSample const& s : p_.gaze_.end_capture())
        if (s.time_s >= onset_s_ && s.time_s <= end_s) gaze_seen_.back().push_back(s);
    p_.gaze_.watch(nullptr);
    p_.gaze_.at(request_.step_index, "");
    mark(end_s, "stimulus_end", {{"shown", letters}});
    dropped += dropped_between(p_.seconds(swap.seen) - last_s, p_.period_s_);
    add_rows("", swap, 0, c);
    for (LoadedStimulus* const k : seen) k->source->rest();
    longest_look_ms_ = std::max(longest_look_ms_, p_.screen_->take_longest_look_ms());

    double const p99_ms = render.empty() ? 0 : gi::quantile(render, 0.99);
    for (char const letter : letters) {
        study::StimulusShown s;
        s.letter = letter;
        s.onset_s = onset_s_;
        s.duration_s = end_s - onset_s_;
        s.onset_method = onset.method;
        s.onset_uncertainty_ms = onset.uncertainty_ms;
        s.frames_planned = stays ? shown + dropped : std::max(1, int(std::lround(length_s / p_.period_s_)));
        s.frames_shown = shown;
        s.frames_dropped = dropped;
        s.render_ms_mean =
            std::accumulate(render.begin(), render.end(), 0.0) / std::max<double>(1, double(render.size()));
        s.render_ms_p99 = p99_ms;
        for (LoadedStimulus const& k : known_) {
            if (k.letter != letter) continue;
            s.settings_sha256 = k.settings.sha256;
            if (k.shown_light) {
                s.clipped_pixels = int(k.shown_light->bright + k.shown_light->dark);
                if (p_.model()->luminance->is_absolute) {
                    s.mean_cd_m2 = k.shown_light->mean_cd_m2;
                    s.peak_cd_m2 = k.shown_light->peak_cd_m2;
                }
            }
            std::size_t const at = letters.find(letter);
            if (ScreenPane const& first = c_shown[at]; first.moment) {
                s.frames_kind = "shown";
                s.frames_drawn = drawn[at];
                s.light_age_ms = 1e3 * (p_.clock_.of_steady(onset_s_) - first.frame->command.pose_s);
            }
            if (!p_.screen_->has_own_views()) {
                s.left_px = c_shown[at].corner_px.x;
                s.top_px = c_shown[at].corner_px.y;
                s.width_px = c_shown[at].size_px.x;
                s.height_px = c_shown[at].size_px.y;
            }
            if (p_.has_degrees() && at < c_shown.size()) {
                study::ScreenGeometry const& screen = *p_.model()->screen;
                s.width_deg = 2 * study::deg_of_place(screen, 0.5 * c_shown[at].size_px.x, false);
                s.height_deg = 2 * study::deg_of_place(screen, 0.5 * c_shown[at].size_px.y, true);
            }
        }
        done_.shown.push_back(std::move(s));
    }
}

void TrialPresenter::Trial::give_feedback()
{
    bool const wanted =
        request_.step->trial.phase == study::Phase::practice ? block_.practice.has_feedback : block_.has_feedback;
    std::string const& right = request_.step->trial.answer;
    if (!wanted || right.empty() || !is_answered_) return;
    bool const is_right = response_.response() == right;
    ScreenContent c = content("");
    c.text = [&](glm::vec2 px) { draw_page(px, {{PageLine::Kind::heading, is_right ? "right" : "wrong"}}, ""); };
    p_.present(c);
    p_.screen_->wait_until(Clock::now() + std::chrono::microseconds(int(1e3 * block_.timing.feedback_ms)));
}

study::TrialDone TrialPresenter::Trial::run()
{
    p_.see_in(known_.front().settings.view.value_or(p_.options_.view));
    p_.gaze_.at(request_.step_index, "");
    mark(p_.now(), "trial", {{"phase", study::name_of(request_.step->trial.phase)}, {"order", order_}});
    show_fixation();
    bool const ready = get_all_ready() && await_fixation();
    if (ready && !block_.is_sequential) {
        appear(order_, true);
    } else if (ready) {
        for (std::size_t i = 0; i < order_.size() && !p_.should_end() && gaze_failure_.empty(); ++i) {
            if (i > 0 && !wait_between(i)) break;
            appear(order_.substr(i, 1), i + 1 == order_.size());
        }
    }
    // The answer may come during or after the last stimulus.
    while (ready && !has_ended()) {
        ScreenContent c = content("");
        int clicked = -1;
        c.text = [&](glm::vec2 px) { clicked = response_.draw(px); };
        p_.present(c);
        if (clicked >= 0 && response_.click(clicked)) is_answered_ = true;
        take_answers();
    }
    longest_look_ms_ = std::max(longest_look_ms_, p_.screen_->take_longest_look_ms());
    done_.step = request_.step_index;
    done_.attempt = request_.attempt;
    done_.level = level_;
    keep_gaze();
    if (p_.should_end()) {
        keep_sounds();
        p_.end_early();
        done_.is_valid = false;
        done_.reason = "skipped";
        return done_;
    }
    if (is_answered_ && response_.given()) {
        GivenAnswer const& by = *response_.given();
        done_.response = response_.response();
        done_.value = block_.task == study::Task::adjustment ? level_ : response_.value();
        done_.response_s = p_.seconds(by.time);
        done_.reaction_ms = 1e3 * (*done_.response_s - onset_s_);
        done_.response_uncertainty_ms = onset_uncertainty_ms_ + longest_look_ms_;
        done_.device = by.input;
        mark(*done_.response_s, "answer", {{"answer", done_.response}, {"input", by.input}});
    }
    if (!gaze_failure_.empty()) {
        done_.is_valid = false;
        done_.reason = gaze_failure_;
    }
    if (is_lost_) {
        done_.is_valid = false;
        done_.reason = "lost_focus";
    }
    keep_sounds();
    give_feedback();
    return done_;
}

study::TrialDone TrialPresenter::show(study::TrialRequest const& request)
{
    SessionStatus& status = experimenter_.status;
    status.trials_done = request.trials_done;
    status.trials_planned = request.trials_planned;
    status.doing =
        fmt::format("trial {} of {}, {}", request.trials_done + 1, request.trials_planned, request.block->name);
    study::TrialDone done = Trial(*this, request).run();
    study::TrialDone judged = done;
    judge(script_, *request.step, judged);
    status.bad_trials += !judged.is_valid;
    status.trials_done += request.attempt == 1 ? 1 : 0; // count each planned trial once
    status.last =
        done.reaction_ms ? fmt::format("{} after {:.0f} ms", done.response, *done.reaction_ms) : done.reason;
    markers_.send(now(), "trial_end",
                  {{"step", request.step_index},
                   {"attempt", request.attempt},
                   {"valid", judged.is_valid},
                   {"reason", judged.reason}});
    keep_gaze_table();
    trial_end_s_ = now();
    return done;
}

} // namespace viewer
