#include "viewer/experiment/answer_keys.h"

#include "gi/core/error.h"
#include "viewer/app/controls.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace viewer {
namespace {

struct Usual {
    char const* answer;
    std::vector<char const*> inputs;
};

std::vector<Usual> const& usual()
{
    static std::vector<Usual> const all{
        {"first", {"key:left", "pad:x", "xr:left/trigger"}},
        {"second", {"key:right", "pad:b", "xr:right/trigger"}},
        {"third", {"key:down", "pad:a"}},
        {"same", {"key:s", "pad:x"}},
        {"different", {"key:d", "pad:b"}},
        {"yes", {"key:y", "pad:a"}},
        {"no", {"key:n", "pad:b"}},
        {"neither", {"key:down", "pad:a"}},
        {"up", {"key:up", "key:right", "pad:up"}},
        {"down", {"key:down", "key:left", "pad:down"}},
        {"confirm", {"key:space", "key:enter", "pad:a", "xr:left/select", "xr:right/select"}}};
    return all;
}

int pad_code(std::string const& name)
{
    static std::map<std::string, int> const kCodes{{"a", GLFW_GAMEPAD_BUTTON_A},
                                                   {"b", GLFW_GAMEPAD_BUTTON_B},
                                                   {"x", GLFW_GAMEPAD_BUTTON_X},
                                                   {"y", GLFW_GAMEPAD_BUTTON_Y},
                                                   {"lb", GLFW_GAMEPAD_BUTTON_LEFT_BUMPER},
                                                   {"rb", GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER},
                                                   {"back", GLFW_GAMEPAD_BUTTON_BACK},
                                                   {"start", GLFW_GAMEPAD_BUTTON_START},
                                                   {"up", GLFW_GAMEPAD_BUTTON_DPAD_UP},
                                                   {"down", GLFW_GAMEPAD_BUTTON_DPAD_DOWN},
                                                   {"left", GLFW_GAMEPAD_BUTTON_DPAD_LEFT},
                                                   {"right", GLFW_GAMEPAD_BUTTON_DPAD_RIGHT}};
    auto const found = kCodes.find(name);
    return found == kCodes.end() ? -1 : found->second;
}

/// Index in a list; -1 = not found.
int number_of(std::string const& name, std::vector<std::string> const& known)
{
    auto const found = std::find(known.begin(), known.end(), name);
    return found == known.end() ? -1 : int(found - known.begin());
}

} // namespace

AnswerKeys::AnswerKeys(study::Script const& script)
{
    for (study::Device const& d : script.devices)
        for (std::string const& input : d.inputs)
            bind(d.answer, input, {script.file, d.place.line, d.place.column});
    auto const is_taken = [n = bindings_.size(), this](std::string const& input) {
        return std::any_of(bindings_.begin(), bindings_.begin() + std::ptrdiff_t(n),
                           [&](Binding const& b) { return b.input == input; });
    };
    for (Usual const& u : usual()) {
        bool const is_bound = std::any_of(bindings_.begin(), bindings_.end(),
                                          [&](Binding const& b) { return b.answer == u.answer; });
        if (is_bound) continue;
        for (char const* const input : u.inputs)
            if (!is_taken(input)) bind(u.answer, input, {});
    }
    for (study::Block const& block : script.blocks)
        for (std::string_view const answer : facts(block.task).answers)
            if (input_of(std::string(answer)).empty())
                throw gi::InputError(gi::TextLocation{script.file, block.place.line, block.place.column},
                                     "block " + block.name,
                                     fmt::format("the script reassigns all default inputs of '{}'", answer),
                                     fmt::format("write devices: {{{}: [key:...]}}", answer));
}

/// Why digits cannot be bound in a script: what types them; empty = nothing.
static std::string types_digits(study::Script const& script)
{
    for (study::Block const& b : script.blocks)
        for (study::Task const task :
             {study::Task::rating, study::Task::ranking, study::Task::magnitude, study::Task::questionnaire})
            if (b.task == task) return fmt::format("{} of block '{}'", facts(task).name, b.name);
    for (study::SequenceItem const& item : script.sequence)
        if (item.kind == study::SequenceKind::questionnaire)
            return fmt::format("questionnaire '{}'", script.questionnaires[std::size_t(item.index)].name);
    return {};
}

static bool is_digit(std::string const& input)
{
    return input.size() == 5 && input.starts_with("key:") && input[4] >= '0' && input[4] <= '9';
}

void find_wrong_devices(study::Script const& script, study::Mistakes& mistakes)
{
    std::string const typed_in = types_digits(script);
    for (study::Device const& d : script.devices)
        for (std::string const& input : d.inputs)
            if (is_digit(input) && !typed_in.empty() &&
                (d.answer == "up" || d.answer == "down" || d.answer == "confirm"))
                mistakes.add(gi::InputError(gi::TextLocation{script.file, d.place.line, d.place.column},
                                            "devices: " + d.answer + ": " + input,
                                            "digits are typed as answers in " + typed_in, "choose another key"));
    std::size_t const before = mistakes.count();
    study::Script one; // with one input at a time, so that each mistake is reported
    one.file = script.file;
    for (study::Device const& d : script.devices)
        for (std::string const& input : d.inputs) {
            one.devices = {{d.answer, {input}, d.place}};
            mistakes.attempt([&] { AnswerKeys const keys(one); });
        }
    if (mistakes.count() == before) mistakes.attempt([&] { AnswerKeys const keys(script); });
}

void AnswerKeys::bind(std::string const& answer, std::string const& input, gi::TextLocation const& place)
{
    auto const colon = input.find(':');
    std::string const device = input.substr(0, colon),
                      name = colon == std::string::npos ? "" : input.substr(colon + 1);
    Binding b{answer, input};
    if (device == "key") {
        b.code = key_code(name);
    } else if (device == "pad") {
        b.kind = InputKind::gamepad_button;
        b.code = pad_code(name);
    } else if (device == "mouse") {
        b.kind = InputKind::mouse_button;
        b.code = number_of(name, {"left", "right", "middle"});
    } else if (device == "xr") {
        auto const slash = name.find('/');
        b.kind = InputKind::hand_button;
        b.device = number_of(name.substr(0, slash), {"left", "right"});
        b.code = b.device < 0 || slash == std::string::npos
                     ? -1
                     : number_of(name.substr(slash + 1), {"select", "trigger", "menu"});
    }
    if (b.kind == InputKind::key && b.code == GLFW_KEY_ESCAPE)
        throw gi::InputError(place, "devices: " + answer + ": " + input, "escape, pressed twice, ends a session",
                             "choose another input");
    if (b.code < 0)
        throw gi::InputError(place, "devices: " + answer + ": " + input, "there is no such input",
                             "write key:left, key:a, key:1, pad:x, mouse:left or xr:left/trigger");
    bindings_.push_back(b);
}

std::optional<GivenAnswer> AnswerKeys::given(InputEvent const& e, std::vector<std::string> const& answers) const
{
    if (e.action != InputAction::press) return {};
    for (Binding const& b : bindings_)
        if (b.kind == e.kind && b.code == e.code && (b.device < 0 || b.device == e.device) &&
            std::find(answers.begin(), answers.end(), b.answer) != answers.end())
            return GivenAnswer{b.answer, b.input, e.time};
    return {};
}

std::string AnswerKeys::input_of(std::string const& answer) const
{
    for (Binding const& b : bindings_)
        if (b.answer == answer) return b.input.substr(b.input.find(':') + 1);
    return {};
}

int digit_of(InputEvent const& e)
{
    if (e.kind != InputKind::key || e.action != InputAction::press) return -1;
    if (e.code >= GLFW_KEY_0 && e.code <= GLFW_KEY_9) return e.code - GLFW_KEY_0;
    if (e.code >= GLFW_KEY_KP_0 && e.code <= GLFW_KEY_KP_9) return e.code - GLFW_KEY_KP_0;
    return -1;
}

} // namespace viewer
