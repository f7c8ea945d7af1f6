#include "viewer/app/controls.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <cctype>
#include <map>
#include <utility>

namespace viewer {
namespace {

constexpr double kClick_px = 4;      // a drag shorter than this is a click
constexpr double kStick_rad_s = 1.5; // full turn of a stick
constexpr double kDeadZone = 0.15;

std::map<int, Command> const kCommands{
    {GLFW_KEY_ESCAPE, Command::close},   {GLFW_KEY_F1, Command::panel},
    {GLFW_KEY_H, Command::help},         {GLFW_KEY_SLASH, Command::help},
    {GLFW_KEY_O, Command::open_scene},   {GLFW_KEY_T, Command::hold_exposure},
    {GLFW_KEY_L, Command::headlight},    {GLFW_KEY_F2, Command::screenshot},
    {GLFW_KEY_F11, Command::swap_eyes},  {GLFW_KEY_TAB, Command::next_navigation},
    {GLFW_KEY_R, Command::first_camera}, {GLFW_KEY_V, Command::next_view},
    {GLFW_KEY_C, Command::compare},      {GLFW_KEY_M, Command::next_method},
    {GLFW_KEY_EQUAL, Command::brighter}, {GLFW_KEY_KP_ADD, Command::brighter},
    {GLFW_KEY_MINUS, Command::darker},   {GLFW_KEY_KP_SUBTRACT, Command::darker},
    {GLFW_KEY_SPACE, Command::play},     {GLFW_KEY_P, Command::reproject}};

constexpr KeyMeaning kMeanings[]{{"W A S D, arrows", "move"},
                                 {"E Q", "up, down"},
                                 {"shift, control", "four times as fast, a quarter"},
                                 {"drag, wheel", "look around, move closer"},
                                 {"click", "select"},
                                 {"control + drag", "move the selected object"},
                                 {"Tab", "fly, walk, orbit"},
                                 {"R", "to the first camera"},
                                 {"O", "open a scene (or drop its file on the window)"},
                                 {"space", "play, pause"},
                                 {"+ -", "exposure by a quarter stop"},
                                 {"T", "exposure: automatic, held"},
                                 {"L", "headlight"},
                                 {"M", "next method"},
                                 {"C", "compare with the reference"},
                                 {"V", "picture, split, flicker, difference"},
                                 {"P", "reprojection"},
                                 {"1 to 9, 0", "stereo modes, in their order"},
                                 {"F11", "swap eyes"},
                                 {"Z, X (held)", "raise the avatar's left, right hand"},
                                 {"F1", "panel"},
                                 {"H, ?", "this help"},
                                 {"F2", "screenshot (PNG and EXR)"},
                                 {"Esc", "quit"}};

} // namespace

double live(double axis) { return std::abs(axis) < kDeadZone ? 0 : axis; }

std::span<KeyMeaning const> key_meanings() { return kMeanings; }

int key_code(std::string const& name)
{
    std::string lower = name;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    if (lower.size() == 1) {
        char const c = lower[0];
        if (c >= 'a' && c <= 'z') return GLFW_KEY_A + (c - 'a');
        if (c >= '0' && c <= '9') return GLFW_KEY_0 + (c - '0');
        if (c == '+' || c == '=') return GLFW_KEY_EQUAL;
        if (c == '-') return GLFW_KEY_MINUS;
        if (c == '?') return GLFW_KEY_SLASH;
        if (c == ' ') return GLFW_KEY_SPACE;
    }
    static std::map<std::string, int> const kNames{{"escape", GLFW_KEY_ESCAPE},
                                                   {"tab", GLFW_KEY_TAB},
                                                   {"space", GLFW_KEY_SPACE},
                                                   {"up", GLFW_KEY_UP},
                                                   {"down", GLFW_KEY_DOWN},
                                                   {"left", GLFW_KEY_LEFT},
                                                   {"right", GLFW_KEY_RIGHT},
                                                   {"enter", GLFW_KEY_ENTER},
                                                   {"backspace", GLFW_KEY_BACKSPACE},
                                                   {"shift", GLFW_KEY_LEFT_SHIFT},
                                                   {"control", GLFW_KEY_LEFT_CONTROL},
                                                   {"f1", GLFW_KEY_F1},
                                                   {"f2", GLFW_KEY_F2},
                                                   {"f11", GLFW_KEY_F11}};
    auto const found = kNames.find(lower);
    return found == kNames.end() ? -1 : found->second;
}

void Controls::key(InputEvent const& e)
{
    if (e.action == InputAction::release) {
        held_.erase(e.code);
        return;
    }
    held_.insert(e.code);
    auto const command = kCommands.find(e.code);
    bool const repeats = e.code == GLFW_KEY_EQUAL || e.code == GLFW_KEY_MINUS;
    if (command != kCommands.end() && (e.action == InputAction::press || repeats))
        commands_.push_back({command->second, mouse_x_, mouse_y_, e.window});
    if (e.action == InputAction::press && e.code >= GLFW_KEY_0 && e.code <= GLFW_KEY_9)
        stereo_mode_ = e.code == GLFW_KEY_0 ? 9 : e.code - GLFW_KEY_1;
}

void Controls::mouse(InputEvent const& e, double height_px)
{
    if (e.kind == InputKind::mouse_button && e.code == GLFW_MOUSE_BUTTON_LEFT) {
        bool const down = e.action == InputAction::press;
        if (down) {
            moved_px_ = 0;
            moving_object_ = (e.modifiers & GLFW_MOD_CONTROL) != 0;
        } else if (dragging_ && moved_px_ < kClick_px) {
            commands_.push_back({Command::select, e.x, e.y, e.window});
        }
        dragging_ = down;
        mouse_x_ = e.x;
        mouse_y_ = e.y;
    }
    if (e.kind != InputKind::mouse_move) return;
    double const dx = e.x - mouse_x_, dy = e.y - mouse_y_;
    mouse_x_ = e.x;
    mouse_y_ = e.y;
    if (!dragging_) return;
    moved_px_ += std::abs(dx) + std::abs(dy);
    if (moving_object_) {
        commands_.push_back({Command::drag, dx, dy, e.window});
    } else {
        double const per_px = 0.5 * gi::kPi / std::max(1.0, height_px);
        turn_right_ += dx * per_px;
        turn_up_ -= dy * per_px;
    }
}

void Controls::take(InputEvent const& e, double height_px)
{
    if (e.kind == InputKind::focus && e.action == InputAction::release) release_all();
    if (e.kind == InputKind::close) commands_.push_back({Command::close, 0, 0, e.window});
    if (e.meant_for == InputFor::panel && e.action != InputAction::release) return;
    if (e.kind == InputKind::key) key(e);
    if (e.kind == InputKind::mouse_button || e.kind == InputKind::mouse_move) mouse(e, height_px);
    if (e.kind == InputKind::scroll) closer_ += e.y;
    if (e.kind == InputKind::gamepad_axis && e.code >= 0 && e.code < 6) axes_[e.code] = e.x;
    if (e.kind == InputKind::gamepad_button && e.action == InputAction::press) {
        if (e.code == GLFW_GAMEPAD_BUTTON_START) commands_.push_back({Command::play, 0, 0, 0});
        if (e.code == GLFW_GAMEPAD_BUTTON_BACK) commands_.push_back({Command::next_navigation, 0, 0, 0});
        if (e.code == GLFW_GAMEPAD_BUTTON_A) commands_.push_back({Command::select, mouse_x_, mouse_y_, 0});
    }
}

void Controls::release_all()
{
    held_.clear();
    std::fill(std::begin(axes_), std::end(axes_), 0.0);
    dragging_ = false;
}

bool Controls::raises_left() const { return held_.contains(GLFW_KEY_Z); }
bool Controls::raises_right() const { return held_.contains(GLFW_KEY_X); }

NavigationInput Controls::motion(double seconds)
{
    auto const held = [&](int a, int b) { return held_.contains(a) || held_.contains(b) ? 1.0 : 0.0; };
    NavigationInput in;
    in.right =
        held(GLFW_KEY_D, GLFW_KEY_RIGHT) - held(GLFW_KEY_A, GLFW_KEY_LEFT) + live(axes_[GLFW_GAMEPAD_AXIS_LEFT_X]);
    in.forward =
        held(GLFW_KEY_W, GLFW_KEY_UP) - held(GLFW_KEY_S, GLFW_KEY_DOWN) - live(axes_[GLFW_GAMEPAD_AXIS_LEFT_Y]);
    double const trigger = 0.5 * (axes_[GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER] - axes_[GLFW_GAMEPAD_AXIS_LEFT_TRIGGER]);
    in.up = held(GLFW_KEY_E, GLFW_KEY_E) - held(GLFW_KEY_Q, GLFW_KEY_Q) + live(trigger);
    in.turn_right_rad = turn_right_ + live(axes_[GLFW_GAMEPAD_AXIS_RIGHT_X]) * kStick_rad_s * seconds;
    in.turn_up_rad = turn_up_ - live(axes_[GLFW_GAMEPAD_AXIS_RIGHT_Y]) * kStick_rad_s * seconds;
    in.closer = closer_;
    in.fast = held_.contains(GLFW_KEY_LEFT_SHIFT) || held_.contains(GLFW_KEY_RIGHT_SHIFT);
    in.slow = held_.contains(GLFW_KEY_LEFT_CONTROL) || held_.contains(GLFW_KEY_RIGHT_CONTROL);
    turn_right_ = turn_up_ = closer_ = 0;
    return in;
}

std::vector<CommandEvent> Controls::commands() { return std::exchange(commands_, {}); }
int Controls::stereo_mode() { return std::exchange(stereo_mode_, -1); }

} // namespace viewer
