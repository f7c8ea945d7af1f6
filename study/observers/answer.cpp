#include "study/observers/answer.h"

#include "study/script/procedure_settings.h"

#include <algorithm>
#include <cmath>

namespace study {
namespace {

constexpr double kNoiseOfJod = 1.4826022185056018 / 1.4142135623730951; ///< 1 / Phi^-1(0.75), per percept

class Answering {
public:
    Answering(Observer const& o, TrialRequest const& r, Random& random)
        : o_(o), r_(r), t_(r.step->trial), block_(*r.block), random_(random)
    {
    }

    ModelAnswer answer()
    {
        switch (block_.task) {
        case Task::ranking:
            return {ranking(), {}};
        case Task::rating:
            return {"confirm", rating()};
        case Task::magnitude:
            return {"confirm", magnitude()};
        case Task::adjustment:
            return {"confirm", adjustment()};
        case Task::questionnaire:
        case Task::free_walk:
            return {"confirm", {}};
        default:
            break;
        }
        if (block_.compare && !block_.compare->vary.empty()) return {of_varied(), {}};
        if (random_.uniform() < o_.model.lapse) return {blindly(""), {}};
        return {of_percepts(), {}};
    }

private:
    /// A random answer other than the given one.
    std::string blindly(std::string const& but)
    {
        std::vector<std::string> answers;
        for (std::string_view const a : facts(block_.task).answers)
            if (a != but) answers.emplace_back(a);
        return answers[random_.below(std::uint32_t(answers.size()))];
    }

    Stimulus const& stimulus(char letter) const { return r_.stimuli[std::size_t(letter - 'a')]; }
    double quality(char letter) const { return o_.quality(stimulus(letter).levels); }
    double noise() { return kNoiseOfJod * o_.model.noise * random_.normal(); }
    std::vector<double> percepts()
    {
        std::vector<double> out;
        for (char const letter : t_.order) out.push_back(quality(letter) + noise());
        return out;
    }

    std::string of_varied()
    {
        Compare const& c = *block_.compare;
        VariedModel const& v = o_.varied(c.vary);
        bool const may_miss = block_.task == Task::yes_no || block_.task == Task::same_different;
        double const guess = may_miss ? o_.model.false_alarms : block_.task == Task::oddity ? 1.0 / 3 : 0.5;
        double right = 1 - guess;
        if (!t_.is_noise) {
            double const lapse = std::min(o_.model.lapse, 1 - guess);
            double const threshold = o_.threshold(v, stimulus('a').levels);
            right = is_many() ? of_many(v, threshold, guess, lapse)
                              : proportion_correct(v.function, v.scale, c.harder_up,
                                                   {threshold, v.slope, guess, lapse}, r_.level.value_or(v.low));
        }
        return random_.uniform() < right ? t_.answer : blindly(t_.answer);
    }

    bool is_many() const
    {
        return std::any_of(block_.procedures.begin(), block_.procedures.end(),
                           [](Procedure const& p) { return p.is_many(); });
    }
    /// By the formula, of all varied settings.
    double of_many(VariedModel const& v, double threshold, double guess, double lapse) const
    {
        std::vector<double> values{r_.level.value_or(v.low)};
        auto const& also = block_.compare->also;
        for (std::size_t i = 0; i < also.size(); ++i)
            values.push_back(r_.stimuli[0].also.empty() ? also[i].usual : r_.stimuli[0].also[i]);
        values.insert(values.end(), {threshold, v.slope, guess, lapse});
        for (auto const& [name, value] : v.parameters) values.push_back(value);
        return std::clamp((*v.function.formula)(values), 0.0, 1.0);
    }

    std::string of_percepts()
    {
        std::vector<double> const p = percepts();
        auto const nearer = [&](double x, double a, double b) { return std::abs(x - a) < std::abs(x - b); };
        switch (block_.task) {
        case Task::two_interval: // the worse one has the signal
            return p[0] + o_.model.side_bias < p[1] ? "first" : "second";
        case Task::abx:
            return nearer(p[2], p[0], p[1]) ? "first" : "second";
        case Task::oddity: {
            int odd = 0;
            double most = -1;
            for (int i = 0; i < 3; ++i) {
                double const others = (p[std::size_t(i + 1) % 3] + p[std::size_t(i + 2) % 3]) / 2;
                double const apart = std::abs(p[std::size_t(i)] - others);
                if (apart > most) {
                    most = apart;
                    odd = i;
                }
            }
            return std::string(facts(block_.task).answers[std::size_t(odd)]);
        }
        case Task::same_different:
            return std::abs(p[0] - p[1]) > 2 * kNoiseOfJod * o_.model.noise ? "different" : "same";
        case Task::yes_no:
            return p[0] < (quality('a') + quality('b')) / 2 ? "yes" : "no";
        default:
            break;
        }
        double const difference = p[0] + o_.model.side_bias - p[1];
        if (block_.may_tie && std::abs(difference) < o_.model.tie_width) return "neither";
        return difference > 0 ? "first" : "second";
    }

    std::string ranking()
    {
        std::vector<double> const p = percepts();
        std::vector<std::size_t> order(p.size());
        for (std::size_t i = 0; i < p.size(); ++i) order[i] = i;
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] > p[b]; });
        std::string letters;
        for (std::size_t const i : order) letters += t_.order[i];
        return letters;
    }

    double rating()
    {
        RatingScale const& s = block_.scale;
        if (random_.uniform() < o_.model.lapse)
            return s.low + s.step * random_.below(std::uint32_t(std::lround((s.high - s.low) / s.step)) + 1);
        double const share =
            o_.model.rating_best + o_.rating_shift + (quality(t_.order[0]) + noise()) / o_.model.rating_span;
        double const steps = std::round((s.high - s.low) * std::clamp(share, 0.0, 1.0) / s.step);
        return std::min(s.low + steps * s.step, s.high);
    }

    double magnitude()
    {
        double const standard = block_.magnitude.modulus > 0 ? block_.magnitude.modulus : 10;
        double const base = block_.magnitude.modulus > 0 && r_.reference ? o_.quality(r_.reference->levels) : 0;
        double const own = block_.magnitude.modulus > 0 ? 0 : 10 * o_.rating_shift;
        return standard * std::exp2(0.5 * (quality('a') + noise() - base) + own);
    }

    double adjustment()
    {
        VariedModel const& v = o_.varied(block_.compare->vary);
        double const low = to_scale(v.scale, block_.compare->low), high = to_scale(v.scale, block_.compare->high);
        double const set = to_scale(v.scale, o_.threshold(v, stimulus('a').levels)) +
                           (high - low) / 24 * o_.model.noise * random_.normal();
        return from_scale(v.scale, std::clamp(set, low, high));
    }

    Observer const& o_;
    TrialRequest const& r_;
    Trial const& t_;
    Block const& block_;
    Random& random_;
};

} // namespace

ModelAnswer answer(Observer const& observer, TrialRequest const& trial, Random& random)
{
    return Answering(observer, trial, random).answer();
}

void answer_items(Observer const& o, Questionnaire const& questionnaire, Random& random, QuestionnaireDone& done)
{
    if (has_text_items(questionnaire)) done.texts.resize(questionnaire.items.size());
    for (std::size_t i = 0; i < questionnaire.items.size(); ++i) {
        QuestionnaireItem const& item = questionnaire.items[i];
        if (item.type == ItemType::text) {
            bool const is_missing = random.uniform() < o.model.items_missing && !item.is_required;
            std::string text = is_missing ? "" : "simulated answer to " + item.id; // an id is ASCII
            text.resize(std::min(text.size(), std::size_t(item.max_chars)));
            done.texts[i] = std::move(text);
            done.answers.emplace_back();
            continue;
        }
        double share = std::clamp(o.model.items_mean + o.model.items_sd * random.normal(), 0.0, 1.0);
        if (item.is_reversed) share = 1 - share;
        double const value = item.low + std::round(share * (item.high - item.low) / item.step) * item.step;
        bool const is_missing = random.uniform() < o.model.items_missing && !item.is_required;
        done.answers.push_back(is_missing ? std::nullopt : std::optional(std::clamp(value, item.low, item.high)));
    }
}

} // namespace study
