#pragma once
// What a participant has answered so far in a trial: keys of choices, a place on a scale, an order, a number.

#include "study/plan/plan.h"
#include "viewer/experiment/answer_keys.h"

#include <glm/vec2.hpp>

namespace viewer {

class Response {
public:
    /// @param shown  letters of the stimuli, in the order in which they are shown   All arguments outlive it.
    Response(study::Block const& block, AnswerKeys const& keys, std::string shown);

    /// True when this event completes the answer.
    bool take(InputEvent const& event);
    /// A box of the scale that was clicked; true when that completes the answer.
    bool click(int step);

    std::string const& response() const { return response_; } ///< empty = none, or it is a value
    std::optional<double> value() const { return value_; }
    std::optional<GivenAnswer> const& given() const { return given_; } ///< the last input that counted
    /// Steps that an adjustment was moved by, up positive, since the last call.
    int take_steps() { return std::exchange(steps_, 0); }

    /// What to press, for people: "left: first   right: second".
    std::string hint() const;
    /// By ImGui, at the bottom of the window: the prompt, the scale, what was typed. @return a box that was
    /// clicked, -1 = none
    int draw(glm::vec2 size_px) const;

private:
    bool take_choice(InputEvent const& event);
    bool take_rating(InputEvent const& event);
    bool take_order(InputEvent const& event);
    bool take_number(InputEvent const& event);
    bool complete(GivenAnswer const& by);

    study::Block const& block_;
    AnswerKeys const& keys_;
    std::string shown_;
    std::vector<std::string> answers_;
    std::string response_, typed_;
    std::optional<double> value_;
    std::optional<GivenAnswer> given_;
    std::vector<double> scale_; ///< of ratings
    int chosen_ = -1, steps_ = 0;
};

/// The values of a scale, lowest first.
std::vector<double> scale_values(double low, double high, double step);

} // namespace viewer
