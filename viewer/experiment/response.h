#pragma once
// A participant's response so far in a trial: a choice, a position on a scale, a rank order, a number.

#include "study/plan/plan.h"
#include "viewer/experiment/answer_keys.h"

#include <glm/vec2.hpp>

namespace viewer {

class Response {
public:
    /// @param shown  letters of the stimuli, in the order of presentation   All arguments must outlive it.
    Response(study::Block const& block, AnswerKeys const& keys, std::string shown);

    /// Processes an event. Returns true if it completes the answer.
    bool take(InputEvent const& event);
    /// Processes a click on a box of the scale. Returns true if it completes the answer.
    bool click(int step);

    std::string const& response() const { return response_; } ///< empty = none, or a numeric value
    std::optional<double> value() const { return value_; }
    std::optional<GivenAnswer> const& given() const { return given_; } ///< the last accepted input
    /// Adjustment steps since the last call, up positive.
    int take_steps() { return std::exchange(steps_, 0); }

    /// Which keys to press, for the participant: "left: first   right: second".
    std::string hint() const;
    /// Draws the prompt, the scale and the typed text at the bottom of the window, by ImGui. @return index of a
    /// clicked box, -1 = none
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
