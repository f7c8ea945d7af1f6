#include "viewer/experiment/page.h"
#include "viewer/experiment/response.h"
#include "viewer/experiment/trial_presenter.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <imgui.h>

namespace viewer {
namespace {

void append_utf8(std::string& text, unsigned unicode)
{
    auto const put = [&](unsigned byte) { text += char(byte); };
    auto const more = [&](int shift) { put(0x80 | ((unicode >> shift) & 0x3f)); };
    if (unicode < 0x80) return put(unicode);
    if (unicode < 0x800) {
        put(0xc0 | (unicode >> 6));
    } else {
        if (unicode < 0x10000) {
            put(0xe0 | (unicode >> 12));
        } else {
            put(0xf0 | (unicode >> 18));
            more(12);
        }
        more(6);
    }
    more(0);
}

/// Removes the last character with all its bytes.
void remove_last(std::string& text)
{
    while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xc0) == 0x80) text.pop_back();
    if (!text.empty()) text.pop_back();
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
    constexpr std::size_t kMost = 2000;
    std::string typed, flaw;
    std::vector<PageLine> const lines{{PageLine::Kind::text, question.text}};
    bool const answered = page(
        [&](glm::vec2 px) {
            draw_page(px, lines, "type, then enter", [&] {
                ImGui::TextWrapped("%s_", typed.c_str());
                if (!flaw.empty()) ImGui::TextWrapped("%s", flaw.c_str());
            });
        },
        [&](InputEvent const& e) {
            if (e.kind == InputKind::character && typed.size() < kMost && e.code >= 32)
                append_utf8(typed, unsigned(e.code));
            if (e.kind != InputKind::key || e.action == InputAction::release) return false;
            if (e.code == GLFW_KEY_BACKSPACE) remove_last(typed);
            bool const is_enter =
                e.action == InputAction::press && (e.code == GLFW_KEY_ENTER || e.code == GLFW_KEY_KP_ENTER);
            if (is_enter && question.type == study::AskedType::number)
                std::replace(typed.begin(), typed.end(), ',', '.'); // a decimal point
            if (is_enter) flaw = flaw_of_answer(question, typed);
            return is_enter && flaw.empty();
        });
    return answered ? std::optional(typed) : std::nullopt;
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
            return e.kind == InputKind::key && e.action == InputAction::press &&
                   (e.code == GLFW_KEY_ENTER || e.code == GLFW_KEY_KP_ENTER);
        });
    if (!answered) return {};
    return chosen >= 0 ? question.choices[std::size_t(chosen)] : std::string();
}

study::QuestionnaireDone TrialPresenter::ask(study::Questionnaire const& q, int step)
{
    study::QuestionnaireDone done{step, now(), 0, {}};
    done.answers.resize(q.items.size());
    experimenter_.status.doing = "questionnaire " + q.name;
    std::string const heading = (q.title.empty() ? q.name : q.title);
    for (std::size_t i = 0; i < q.items.size() && !should_end();) {
        study::QuestionnaireItem const& item = q.items[i];
        std::vector<double> const values = scale_values(item.low, item.high, item.step);
        bool const labelled = item.labels.size() == values.size();
        std::vector<std::string> steps;
        for (std::size_t k = 0; k < values.size(); ++k)
            steps.push_back(values.size() > 11 && k % 5 != 0 ? "" : fmt::format("{:g}", values[k]));
        std::string const low = item.labels.empty() ? "" : item.labels.front(),
                          high = item.labels.empty() ? "" : item.labels.back();
        std::vector<PageLine> lines{{PageLine::Kind::heading, heading}};
        if (i == 0 && !q.instructions.empty())
            for (PageLine const& line : parse_page(q.instructions)) lines.push_back(line);
        lines.push_back({PageLine::Kind::gap, ""});
        lines.push_back({PageLine::Kind::text, item.text});
        int chosen = -1;
        if (done.answers[i]) chosen = int(std::lround((*done.answers[i] - item.low) / item.step));
        int go = 0; // 1 = to the next item, -1 = back
        bool const answered = page(
            [&](glm::vec2 px) {
                std::string const footer = fmt::format(
                    "{} of {}     {} and {}, {}: next     backspace: back     tab: no answer", i + 1,
                    q.items.size(), keys_.input_of("down"), keys_.input_of("up"), keys_.input_of("confirm"));
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
                    if (e.code == GLFW_KEY_TAB) {
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
        if (!answered) break; // skipped: the remaining items stay unanswered
        done.answers[i] = chosen < 0 ? std::nullopt : std::optional(values[std::size_t(chosen)]);
        i = go < 0 ? i - 1 : i + 1;
    }
    done.end_s = now();
    return done;
}

} // namespace viewer
