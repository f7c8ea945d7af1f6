#include "viewer/experiment/response.h"

#include "viewer/experiment/page.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <imgui.h>

namespace viewer {

using study::Task;

std::vector<double> scale_values(double low, double high, double step)
{
    std::vector<double> values;
    int const count = step > 0 ? int(std::floor((high - low) / step + 1e-9)) : 0;
    for (int i = 0; i <= count; ++i) values.push_back(low + i * step);
    return values;
}

Response::Response(study::Block const& block, AnswerKeys const& keys, std::string shown)
    : block_(block), keys_(keys), shown_(std::move(shown))
{
    for (std::string_view const a : facts(block.task).answers) answers_.emplace_back(a);
    if (block.may_tie) answers_.emplace_back("neither");
    if (block.task == Task::rating) scale_ = scale_values(block.scale.low, block.scale.high, block.scale.step);
}

bool Response::complete(GivenAnswer const& by)
{
    given_ = by;
    if (response_.empty()) response_ = by.answer; // the value is stored separately
    return true;
}

bool Response::take(InputEvent const& event)
{
    switch (block_.task) {
    case Task::rating:
        return take_rating(event);
    case Task::ranking:
        return take_order(event);
    case Task::magnitude:
        return take_number(event);
    case Task::adjustment:
        if (auto const given = keys_.given(event, answers_)) {
            if (given->answer == "confirm") return complete(*given);
            steps_ += given->answer == "up" ? 1 : -1;
        }
        return false;
    default:
        return take_choice(event);
    }
}

bool Response::take_choice(InputEvent const& event)
{
    auto const given = keys_.given(event, answers_);
    if (!given) return false;
    response_ = given->answer;
    return complete(*given);
}

bool Response::take_rating(InputEvent const& event)
{
    if (int const digit = digit_of(event); digit >= 0) {
        for (double const v : scale_)
            if (v == digit) {
                value_ = v;
                return complete({"confirm", "key:" + std::to_string(digit), event.time});
            }
        return false;
    }
    auto const given = keys_.given(event, answers_);
    if (!given) return false;
    if (given->answer == "confirm") {
        if (chosen_ < 0) return false;
        value_ = scale_[std::size_t(chosen_)];
        return complete(*given);
    }
    int const last = int(scale_.size()) - 1;
    if (chosen_ < 0)
        chosen_ = last / 2;
    else
        chosen_ = std::clamp(chosen_ + (given->answer == "up" ? 1 : -1), 0, last);
    return false;
}

bool Response::click(int step)
{
    if (block_.task != Task::rating || step < 0 || std::size_t(step) >= scale_.size()) return false;
    value_ = scale_[std::size_t(step)];
    return complete({"confirm", "mouse:left", InputEvent::Clock::now()});
}

/// Rank order by the numbers of the places on the screen, best first.
bool Response::take_order(InputEvent const& event)
{
    if (event.kind == InputKind::key && event.action == InputAction::press && event.code == GLFW_KEY_BACKSPACE &&
        !response_.empty())
        response_.pop_back();
    int const digit = digit_of(event);
    if (digit < 1 || std::size_t(digit) > shown_.size()) return false;
    char const letter = shown_[std::size_t(digit) - 1];
    if (response_.find(letter) != std::string::npos) return false;
    response_ += letter;
    return response_.size() == shown_.size() && complete({"confirm", "key:" + std::to_string(digit), event.time});
}

bool Response::take_number(InputEvent const& event)
{
    constexpr std::size_t kMost = 12;
    if (event.kind == InputKind::character) {
        char const c = event.code == ',' ? '.' : char(event.code);
        bool const point = (event.code == '.' || event.code == ',') && typed_.find('.') == std::string::npos;
        bool const digit = event.code >= '0' && event.code <= '9';
        if ((point || digit) && typed_.size() < kMost) typed_ += c;
        return false;
    }
    if (event.kind == InputKind::key && event.action != InputAction::release && event.code == GLFW_KEY_BACKSPACE &&
        !typed_.empty())
        typed_.pop_back();
    auto const given = keys_.given(event, {"confirm"});
    if (!given || typed_.empty() || typed_ == ".") return false;
    double const value = std::strtod(typed_.c_str(), nullptr);
    if (!(value > 0)) return false;
    value_ = value;
    return complete(*given);
}

std::string Response::hint() const
{
    switch (block_.task) {
    case Task::rating:
        return "";
    case Task::ranking:
        return fmt::format("press 1 to {}, best first (backspace takes one back)", shown_.size());
    case Task::magnitude:
        return "type a number, then enter";
    case Task::adjustment:
        return fmt::format("{} and {} change it, {} is done", keys_.input_of("up"), keys_.input_of("down"),
                           keys_.input_of("confirm"));
    default: {
        std::string text;
        for (std::string const& a : answers_)
            text += (text.empty() ? "" : "     ") + fmt::format("{}: {}", a, keys_.input_of(a));
        return text;
    }
    }
}

int Response::draw(glm::vec2 size_px) const
{
    std::string const hint = this->hint();
    if (block_.task == Task::rating) {
        int clicked = -1;
        std::vector<std::string> steps;
        for (double const v : scale_) steps.push_back(fmt::format("{:g}", v));
        std::string low, high;
        for (auto const& [value, label] : block_.scale.labels) {
            if (value == block_.scale.low) low = label;
            if (value == block_.scale.high) high = label;
        }
        float const tall = 6.5f * ImGui::GetFontSize();
        ImGui::SetNextWindowPos({0, size_px.y - tall});
        ImGui::SetNextWindowSize({size_px.x, tall});
        ImGui::PushStyleColor(ImGuiCol_Text, {0.12f, 0.12f, 0.12f, 1});
        ImGui::Begin("scale", nullptr,
                     ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoBackground |
                         ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoSavedSettings);
        float const wide = ImGui::CalcTextSize(block_.prompt.c_str()).x;
        ImGui::SetCursorPosX(std::max(0.0f, 0.5f * (size_px.x - wide)));
        ImGui::TextUnformatted(block_.prompt.c_str());
        ImGui::SetCursorPosX(0);
        clicked = draw_scale(size_px.x, steps, low, high, chosen_);
        ImGui::End();
        ImGui::PopStyleColor();
        return clicked;
    }
    std::string text = block_.prompt + (block_.prompt.empty() ? "" : "\n") + hint;
    if (block_.task == Task::magnitude) text = block_.prompt + "\n" + hint + ": " + typed_ + "_";
    if (block_.task == Task::ranking && !response_.empty()) {
        text += "\nso far:";
        for (char const letter : response_) text += fmt::format(" {}", shown_.find(letter) + 1);
    }
    draw_prompt(size_px, text);
    return -1;
}

} // namespace viewer
