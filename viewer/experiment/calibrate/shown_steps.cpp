#include "viewer/experiment/calibrate/shown_steps.h"

#include "gi/core/error.h"
#include "gi/core/text.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <imgui.h>

namespace viewer {
namespace {

constexpr double kDrawings_Hz = 30;
constexpr int kByteSteps = 255, kLargeStep = 16;

ImU32 colour_of(study::PatchColour colour, double value)
{
    int const v = int(std::lround(kByteSteps * value));
    using study::PatchColour;
    bool const all = colour == PatchColour::white;
    return IM_COL32(all || colour == PatchColour::red ? v : 0, all || colour == PatchColour::green ? v : 0,
                    all || colour == PatchColour::blue ? v : 0, 255);
}

/// A line at the bottom of the window; dim, so that it hardly lights the patch.
void draw_hint(glm::vec2 px, std::string const& text)
{
    ImVec2 const size = ImGui::CalcTextSize(text.c_str());
    ImGui::GetBackgroundDrawList()->AddText({0.5f * (px.x - size.x), px.y - 1.5f * size.y},
                                            IM_COL32(96, 96, 96, 255), text.c_str());
}

void fill(glm::vec2 from, glm::vec2 to, ImU32 colour)
{
    ImGui::GetBackgroundDrawList()->AddRectFilled({std::floor(from.x), std::floor(from.y)},
                                                  {std::floor(to.x), std::floor(to.y)}, colour);
}

enum class StepEnd { no, taken, back };

/// Draws until `take` says that the step ends.
/// @throws gi::InputError the window was closed, or escape was pressed
template <class Draw, class Take>
StepEnd run_step(Screen& screen, Draw const& draw, Take const& take)
{
    screen.take_input();
    while (true) {
        ScreenContent content;
        content.text = draw;
        screen.present(content);
        screen.wait_until(InputEvent::Clock::now() + std::chrono::microseconds(int(1e6 / kDrawings_Hz)));
        for (InputEvent const& e : screen.take_input()) {
            bool const is_key = e.kind == InputKind::key && e.action != InputAction::release;
            if (e.kind == InputKind::close || (is_key && e.code == GLFW_KEY_ESCAPE))
                throw gi::InputError("the calibration was ended", "its steps were not all done",
                                     "start it again; readings so far are in the file of --readings-out");
            bool const is_enter = is_key && (e.code == GLFW_KEY_ENTER || e.code == GLFW_KEY_KP_ENTER);
            if (is_enter && e.action == InputAction::repeat) continue; // held from the step before
            if (is_enter) {
                if (take(e)) return StepEnd::taken;
            } else if (is_key && e.code == GLFW_KEY_BACKSPACE && e.action == InputAction::press) {
                if (take(e)) return StepEnd::back;
            } else {
                take(e);
            }
        }
    }
}

/// Change by a key, in steps; 0 = another key.
int steps_of(InputEvent const& e)
{
    if (e.kind != InputKind::key || e.action == InputAction::release) return 0;
    switch (e.code) {
    case GLFW_KEY_UP:
    case GLFW_KEY_RIGHT:
        return 1;
    case GLFW_KEY_DOWN:
    case GLFW_KEY_LEFT:
        return -1;
    case GLFW_KEY_PAGE_UP:
        return kLargeStep;
    case GLFW_KEY_PAGE_DOWN:
        return -kLargeStep;
    default:
        return 0;
    }
}

bool is_key(InputEvent const& e, int code) { return e.kind == InputKind::key && e.code == code; }

} // namespace

void measure_patches(Screen& screen, std::vector<study::PatchColour> const& colours,
                     std::vector<double> const& values,
                     std::function<void(std::vector<study::LuminanceReading> const&)> const& keep)
{
    std::vector<study::LuminanceReading> readings;
    std::size_t const count = colours.size() * values.size();
    std::string typed;
    for (std::size_t i = 0; i < count;) {
        study::PatchColour const colour = colours[i / values.size()];
        double const value = values[i % values.size()];
        auto const draw = [&](glm::vec2 px) {
            fill({0, 0}, px, IM_COL32(0, 0, 0, 255));
            glm::vec2 const half(0.25f * std::min(px.x, px.y));
            fill(0.5f * px - half, 0.5f * px + half, colour_of(colour, value));
            draw_hint(px, fmt::format("{} of {}: {} {:.0f}/255   cd/m2: {}_   enter   backspace: back", i + 1,
                                      count, name_of(colour), kByteSteps * value, typed));
        };
        std::optional<double> luminance;
        StepEnd const end = run_step(screen, draw, [&](InputEvent const& e) {
            if (e.kind == InputKind::character && typed.size() < 12 &&
                ((e.code >= '0' && e.code <= '9') || e.code == '.' || e.code == ',' || e.code == 'e' ||
                 e.code == '-'))
                typed += e.code == ',' ? '.' : char(e.code);
            if (is_key(e, GLFW_KEY_BACKSPACE)) {
                if (typed.empty()) return i > 0;
                typed.pop_back();
            }
            if (!is_key(e, GLFW_KEY_ENTER) && !is_key(e, GLFW_KEY_KP_ENTER)) return false;
            luminance = gi::parse_finite(typed);
            if (luminance && *luminance >= 0) return true;
            typed.clear(); // no number: again
            return false;
        });
        typed.clear();
        if (end == StepEnd::back) {
            readings.pop_back();
            --i;
            continue;
        }
        readings.push_back({colour, value, *luminance});
        keep(readings);
        ++i;
    }
}

std::vector<study::GammaMatch> match_patterns(Screen& screen, std::vector<study::PatchColour> const& colours,
                                              std::vector<double> const& shares)
{
    std::vector<study::GammaMatch> matches;
    std::size_t const count = colours.size() * shares.size();
    for (std::size_t i = 0; i < count;) {
        study::PatchColour const colour = colours[i / shares.size()];
        double const share = shares[i % shares.size()];
        int value = kByteSteps / 2 + 1;
        auto const draw = [&](glm::vec2 px) {
            fill({0, 0}, px, IM_COL32(0, 0, 0, 255));
            float const side = std::floor(0.6f * std::min(px.x, px.y)), top = std::floor(0.5f * (px.y - side));
            float const middle = std::floor(0.5f * px.x);
            fill({middle, top}, {middle + side, top + side}, colour_of(colour, double(value) / kByteSteps));
            double sum = 0; // error diffusion along the lines: any share
            for (int line = 0; line < int(side); ++line) {
                sum += share;
                bool const is_bright = sum >= 1 - 1e-9;
                if (is_bright) sum -= 1;
                fill({middle - side, top + float(line)}, {middle, top + float(line + 1)},
                     colour_of(colour, is_bright ? 1 : 0));
            }
            draw_hint(px,
                      fmt::format("{} of {}: {} {}   up, down, page up, page down: make both halves alike, from "
                                  "afar   enter",
                                  i + 1, count, name_of(colour), value));
        };
        StepEnd const end = run_step(screen, draw, [&](InputEvent const& e) {
            value = std::clamp(value + steps_of(e), 1, kByteSteps - 1);
            if (is_key(e, GLFW_KEY_BACKSPACE)) return i > 0;
            return is_key(e, GLFW_KEY_ENTER) || is_key(e, GLFW_KEY_KP_ENTER);
        });
        if (end == StepEnd::back) {
            matches.pop_back();
            --i;
            continue;
        }
        matches.push_back({colour, share, double(value) / kByteSteps});
        ++i;
    }
    return matches;
}

double match_card(Screen& screen)
{
    int width = 320; // px
    glm::ivec2 const px = screen.size_px();
    auto const draw = [&](glm::vec2 size) {
        fill({0, 0}, size, IM_COL32(40, 40, 40, 255));
        glm::vec2 const card(float(width), std::round(float(width * kCardHeight_cm / kCardWidth_cm)));
        glm::vec2 const corner = glm::floor(0.5f * (size - card));
        fill(corner, corner + card, IM_COL32(190, 190, 190, 255));
        draw_hint(size, fmt::format(
                            "{} px   hold a bank card on the rectangle; left, right, page up, page down until it "
                            "just covers it; enter",
                            width));
    };
    run_step(screen, draw, [&](InputEvent const& e) {
        width = std::clamp(width + steps_of(e), 40, std::max(40, px.x - 20));
        return is_key(e, GLFW_KEY_ENTER) || is_key(e, GLFW_KEY_KP_ENTER);
    });
    return width / kCardWidth_cm;
}

} // namespace viewer
