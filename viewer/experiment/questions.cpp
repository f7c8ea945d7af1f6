#include "viewer/experiment/page.h"
#include "viewer/experiment/response.h"
#include "viewer/experiment/text_entry.h"
#include "viewer/experiment/trial_presenter.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <imgui.h>

namespace viewer {
namespace {

bool is_enter(InputEvent const& e)
{
    return e.kind == InputKind::key && e.action == InputAction::press &&
           (e.code == GLFW_KEY_ENTER || e.code == GLFW_KEY_KP_ENTER);
}

} // namespace

bool TrialPresenter::ask_consent(std::string const& markdown)
{
    bool agreed = false;
    experimenter_.status.doing = "consent";
    std::vector<PageLine> const lines = parse_page(markdown);
    auto const draw = [&](glm::vec2 px) { draw_page(px, lines, "y: I agree     n: I do not"); };
    auto const answer = [&](InputEvent const& e) {
        if (e.kind != InputKind::key || e.action != InputAction::press) return false;
        agreed = e.code == GLFW_KEY_Y;
        return agreed || e.code == GLFW_KEY_N;
    };
    while (!page(draw, answer)) { // cannot be skipped, because only the participant can answer
    }
    return agreed;
}

study::ParticipantAsked TrialPresenter::ask_participant(std::vector<study::AskedQuestion> const& questions)
{
    study::ParticipantAsked asked;
    for (study::AskedQuestion const& question : questions) {
        auto const answer =
            question.type == study::AskedType::choice ? choose_answer(question) : type_answer(question);
        if (!answer) break; // skipped
        asked.answers.emplace_back(question.id, *answer);
    }
    return asked;
}

/// Typed text, asked until it is an answer.
std::optional<std::string> TrialPresenter::type_answer(study::AskedQuestion const& question)
{
    TextEntry typed(1, 1000);
    std::string flaw;
    std::vector<PageLine> const lines{{PageLine::Kind::text, question.text}};
    std::string answer;
    bool const answered = page(
        [&](glm::vec2 px) {
            draw_page(px, lines, "type, then enter", [&] {
                typed.draw(ImGui::GetContentRegionAvail().x);
                if (!flaw.empty()) ImGui::TextWrapped("%s", flaw.c_str());
            });
        },
        [&](InputEvent const& e) {
            typed.take(e);
            if (!is_enter(e)) return false;
            answer = typed.text();
            if (question.type == study::AskedType::number)
                std::replace(answer.begin(), answer.end(), ',', '.'); // a decimal point
            flaw = flaw_of_answer(question, answer);
            return flaw.empty();
        });
    return answered ? std::optional(answer) : std::nullopt;
}

/// One of at most nine choices, by its digit; enter without one = no answer.
std::optional<std::string> TrialPresenter::choose_answer(study::AskedQuestion const& question)
{
    int chosen = -1;
    std::vector<PageLine> lines{{PageLine::Kind::text, question.text}, {PageLine::Kind::gap, ""}};
    for (std::size_t i = 0; i < question.choices.size(); ++i)
        lines.push_back({PageLine::Kind::text, fmt::format("{}   {}", i + 1, question.choices[i])});
    bool const answered = page(
        [&](glm::vec2 px) {
            draw_page(px, lines, "digit, then enter", [&] {
                if (chosen >= 0) ImGui::TextWrapped("%s", question.choices[std::size_t(chosen)].c_str());
            });
        },
        [&](InputEvent const& e) {
            int const digit = digit_of(e);
            if (digit >= 1 && digit <= int(question.choices.size())) chosen = digit - 1;
            return is_enter(e);
        });
    if (!answered) return {};
    return chosen >= 0 ? question.choices[std::size_t(chosen)] : std::string();
}

study::QuestionnaireDone TrialPresenter::ask(study::QuestionnaireRequest const& r)
{
    study::Questionnaire const& q = *r.questionnaire;
    study::QuestionnaireDone done{r.step, now(), 0, {}};
    done.answers.resize(q.items.size());
    if (has_text_items(q)) done.texts.resize(q.items.size());
    std::size_t i = 0;
    for (study::ItemAnswered const& given : r.given) {
        if (given.item < 0 || given.item >= int(q.items.size())) continue;
        i = std::size_t(given.item);
        done.answers[i] = given.answer;
        if (!done.texts.empty()) done.texts[i] = given.text;
        ++i;
    }
    experimenter_.status.doing = "questionnaire " + q.name;
    while (i < q.items.size() && !should_end()) {
        std::vector<PageLine> lines{{PageLine::Kind::heading, q.title.empty() ? q.name : q.title}};
        if (i == 0 && !q.instructions.empty())
            for (PageLine const& line : parse_page(q.instructions)) lines.push_back(line);
        lines.push_back({PageLine::Kind::gap, ""});
        lines.push_back({PageLine::Kind::text, q.items[i].text});
        bool const is_text = q.items[i].type == study::ItemType::text;
        int const go = is_text ? type_item(q, i, lines, done.texts[i]) : choose_item(q, i, lines, done.answers[i]);
        if (go == 0) break; // skipped: the remaining items stay unanswered
        if (r.keep) r.keep({r.step, now(), int(i), done.answers[i], is_text ? done.texts[i] : std::string()});
        i = go < 0 ? i - 1 : i + 1;
    }
    done.end_s = now();
    return done;
}

/// A text; Enter continues, or Ctrl+Enter if Enter begins a line. @return 1 = to the next item, -1 = back, 0 =
/// skipped by the experimenter
int TrialPresenter::type_item(study::Questionnaire const& q, std::size_t i, std::vector<PageLine> const& lines,
                              std::string& text)
{
    study::QuestionnaireItem const& item = q.items[i];
    TextEntry typed(item.lines, item.max_chars, text);
    std::string flaw;
    int go = 0;
    std::string const footer = fmt::format("{} of {}     type     {}enter: next{}", i + 1, q.items.size(),
                                           item.lines > 1 ? "ctrl + " : "", i > 0 ? "     page up: back" : "");
    bool const answered = page(
        [&](glm::vec2 px) {
            draw_page(px, lines, footer, [&] {
                typed.draw(ImGui::GetContentRegionAvail().x);
                if (!flaw.empty())
                    ImGui::TextWrapped("%s", flaw.c_str());
                else if (typed.is_full())
                    ImGui::TextWrapped("at most %d characters", item.max_chars);
            });
        },
        [&](InputEvent const& e) {
            typed.take(e);
            if (e.kind != InputKind::key || e.action != InputAction::press) return false;
            if (e.code == GLFW_KEY_PAGE_UP && i > 0) go = -1;
            if (is_enter(e) && (item.lines == 1 || (e.modifiers & GLFW_MOD_CONTROL) != 0)) {
                flaw = flaw_of_text(item, typed.text());
                go = flaw.empty() ? 1 : 0;
            }
            return go != 0;
        });
    if (!answered) return 0;
    text = typed.text();
    return go;
}

/// A value of a scale. @return as type_item
int TrialPresenter::choose_item(study::Questionnaire const& q, std::size_t i, std::vector<PageLine> const& lines,
                                std::optional<double>& answer)
{
    study::QuestionnaireItem const& item = q.items[i];
    std::vector<double> const values = scale_values(item.low, item.high, item.step);
    bool const labelled = item.labels.size() == values.size();
    std::vector<std::string> steps;
    for (std::size_t k = 0; k < values.size(); ++k)
        steps.push_back(values.size() > 11 && k % 5 != 0 ? "" : fmt::format("{:g}", values[k]));
    std::string const low = item.labels.empty() ? "" : item.labels.front(),
                      high = item.labels.empty() ? "" : item.labels.back();
    int chosen = answer ? int(std::lround((*answer - item.low) / item.step)) : -1;
    int go = 0;
    bool const answered = page(
        [&](glm::vec2 px) {
            std::string const footer =
                fmt::format("{} of {}     {} and {}, {}: next     backspace: back{}", i + 1, q.items.size(),
                            keys_.input_of("down"), keys_.input_of("up"), keys_.input_of("confirm"),
                            item.is_required ? "" : "     tab: no answer");
            draw_page(px, lines, footer, [&] {
                int const clicked = draw_scale(ImGui::GetContentRegionAvail().x, steps, low, high, chosen);
                if (clicked >= 0) chosen = clicked;
                if (labelled && chosen >= 0) ImGui::TextUnformatted(item.labels[std::size_t(chosen)].c_str());
            });
        },
        [&](InputEvent const& e) {
            int const last = int(values.size()) - 1;
            if (int const digit = digit_of(e); digit >= 0)
                for (std::size_t k = 0; k < values.size(); ++k)
                    if (values[k] == digit) chosen = int(k);
            if (e.kind == InputKind::key && e.action == InputAction::press) {
                if (e.code == GLFW_KEY_BACKSPACE && i > 0) go = -1;
                if (e.code == GLFW_KEY_TAB && !item.is_required) {
                    chosen = -1;
                    go = 1;
                }
            }
            if (auto const given = keys_.given(e, {"up", "down", "confirm"})) {
                if (given->answer == "confirm")
                    go = chosen >= 0 ? 1 : 0;
                else
                    chosen =
                        chosen < 0 ? last / 2 : std::clamp(chosen + (given->answer == "up" ? 1 : -1), 0, last);
            }
            return go != 0;
        });
    if (!answered) return 0;
    answer = chosen < 0 ? std::nullopt : std::optional(values[std::size_t(chosen)]);
    return go;
}

} // namespace viewer
