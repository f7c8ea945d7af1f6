#include "study/run/adaptive_run.h"

#include "study/script/condition.h"
#include "study/script/procedure_settings.h"

#include <algorithm>
#include <charconv>
#include <set>
#include <stdexcept>

namespace study {
namespace {

/// The level as shown: settings have nine digits, so that sums of steps return to the same levels.
double as_shown(double level)
{
    std::string const text = level_text(level);
    std::from_chars(text.data(), text.data() + text.size(), level);
    return level;
}

} // namespace

AdaptiveRun::Chooser AdaptiveRun::method_for(Procedure const& p, Compare const& c)
{
    if (p.method == study::Method::staircase) return Staircase(staircase_settings(p, c));
    if (p.is_many()) return QuestMany{QuestPlusMany(quest_many_settings(p)), 0, p.stop.trials};
    return Quest{QuestPlus(quest_settings(p, c)), p.stimuli, 0, p.stop.trials};
}

AdaptiveRun::AdaptiveRun(Procedure const& p, Compare const& c, std::string const& file)
try : scale_(c.scale), sign_(harder_sign(c)), method_(method_for(p, c)) {
    choose_next();
} catch (std::invalid_argument const& e) {
    throw ScriptError(file, p.place, "procedure '" + p.name + "' cannot be run", e.what(), "");
}

void AdaptiveRun::respond(bool is_correct)
{
    if (auto* const staircase = std::get_if<Staircase>(&method_)) {
        staircase->respond(is_correct);
    } else if (auto* const many = std::get_if<QuestMany>(&method_)) {
        many->quest.respond(many->next, is_correct);
        --many->left;
    } else {
        Quest& q = std::get<Quest>(method_);
        q.quest.respond(q.next, is_correct);
        --q.left;
    }
    choose_next();
}

void AdaptiveRun::choose(double level, std::vector<double> const& also)
{
    std::invalid_argument const impossible(level_text(level) + " is no level of the procedure");
    if (auto* const staircase = std::get_if<Staircase>(&method_)) {
        double const at = sign_ * to_scale(scale_, level), low = staircase->settings().low,
                     high = staircase->settings().high, tolerance = 1e-6 * (high - low);
        if (!(at >= low - tolerance && at <= high + tolerance)) throw impossible;
        staircase->move_to(at);
    } else if (auto* const many = std::get_if<QuestMany>(&method_)) {
        std::vector<double> stimulus{level};
        stimulus.insert(stimulus.end(), also.begin(), also.end());
        auto const index = many->quest.index_of(stimulus);
        if (!index) throw impossible;
        many->next = *index;
    } else {
        Quest& q = std::get<Quest>(method_);
        auto const at = std::find_if(q.levels.begin(), q.levels.end(),
                                     [&](double known) { return level_text(known) == level_text(level); });
        if (at == q.levels.end()) throw impossible;
        q.next = std::size_t(at - q.levels.begin());
    }
    level_ = level;
    also_ = also;
}

void AdaptiveRun::choose_next()
{
    if (auto const* const staircase = std::get_if<Staircase>(&method_)) {
        is_finished_ = staircase->finished();
        level_ = as_shown(from_scale(scale_, sign_ * staircase->level()));
        return;
    }
    if (auto* const many = std::get_if<QuestMany>(&method_)) {
        is_finished_ = many->left == 0;
        if (is_finished_) return;
        many->next = many->quest.next();
        auto const stimulus = many->quest.stimulus(many->next);
        level_ = as_shown(stimulus[0]);
        also_.clear();
        for (std::size_t i = 1; i < stimulus.size(); ++i) also_.push_back(as_shown(stimulus[i]));
        return;
    }
    Quest& q = std::get<Quest>(method_);
    is_finished_ = q.left == 0;
    if (is_finished_) return;
    q.next = q.quest.next();
    level_ = as_shown(q.levels[q.next]);
}

std::vector<double> reachable_levels(Procedure const& p, Compare const& c)
{
    constexpr std::size_t kMost = 10000;
    std::set<double> levels;
    if (p.method == study::Method::questplus)
        for (double const level : p.stimuli) levels.insert(as_shown(level));
    if (p.method != study::Method::staircase) return {levels.begin(), levels.end()};
    StaircaseSettings const s = staircase_settings(p, c);
    double const sign = harder_sign(c);
    std::vector<double> open{s.start};
    while (!open.empty() && levels.size() <= kMost) {
        double const at = open.back();
        open.pop_back();
        if (!levels.insert(as_shown(from_scale(c.scale, sign * at))).second) continue;
        for (double const step : s.steps)
            for (double const by : {-step, s.up_ratio * step}) open.push_back(std::clamp(at + by, s.low, s.high));
    }
    if (levels.size() > kMost) levels.clear();
    return {levels.begin(), levels.end()};
}

} // namespace study
