#pragma once
// Maps inputs to answers: those in the script's `devices`, or default ones for answers without an entry.

#include "study/script/mistakes.h"
#include "study/script/script.h"
#include "viewer/devices/gl/input_event.h"

#include <optional>
#include <string>
#include <vector>

namespace viewer {

/// A given answer.
struct GivenAnswer {
    std::string answer; ///< "first"
    std::string input;  ///< "key:left"
    InputEvent::Clock::time_point time;
};

class AnswerKeys {
public:
    /// Throws InputError, with its line in the script, if an input is unknown or an answer has no input left.
    /// Inputs are key:NAME, pad:NAME, mouse:NAME, xr:left/trigger.
    explicit AnswerKeys(study::Script const& script);

    /// The answer, if the event presses an input of one of these answers.
    std::optional<GivenAnswer> given(InputEvent const& event, std::vector<std::string> const& answers) const;
    /// First input of an answer without its device, e.g. "left", for display; empty = none.
    std::string input_of(std::string const& answer) const;

private:
    struct Binding {
        std::string answer, input;
        InputKind kind = InputKind::key;
        int code = 0, device = -1; ///< device: -1 = any
    };
    void bind(std::string const& answer, std::string const& input, gi::TextLocation const& place);

    std::vector<Binding> bindings_;
};

/// Adds every mistake in a script's `devices`.
void find_wrong_devices(study::Script const& script, study::Mistakes& mistakes);

/// The digit pressed, also on the keypad; -1 = none.
int digit_of(InputEvent const& event);

} // namespace viewer
