#pragma once
// Which input gives which answer: those of the script's `devices`, or where it has none for an answer, the usual
// ones.

#include "study/script/script.h"
#include "viewer/devices/gl/input_event.h"

#include <optional>
#include <string>
#include <vector>

namespace viewer {

/// An answer that was given.
struct GivenAnswer {
    std::string answer; ///< "first"
    std::string input;  ///< "key:left"
    InputEvent::Clock::time_point time;
};

class AnswerKeys {
public:
    /// Throws InputError on an input that is not known: key:NAME, pad:NAME, mouse:NAME,
    /// xr:left/trigger
    explicit AnswerKeys(study::Script const& script);

    /// Where this event is the press of an input of one of these answers.
    std::optional<GivenAnswer> given(InputEvent const& event, std::vector<std::string> const& answers) const;
    /// "left" for people: the first input of an answer, without its device; empty = none.
    std::string input_of(std::string const& answer) const;

private:
    struct Binding {
        std::string answer, input;
        InputKind kind = InputKind::key;
        int code = 0, device = -1; ///< device: -1 = any
    };
    void bind(std::string const& answer, std::string const& input);

    std::vector<Binding> bindings_;
};

/// A digit that was pressed, also on the keypad; -1 = none.
int digit_of(InputEvent const& event);

} // namespace viewer
