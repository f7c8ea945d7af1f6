#include "viewer/experiment/page.h"

#include <algorithm>
#include <cmath>
#include <imgui.h>

namespace viewer {
namespace {

constexpr float kDark = 0.12f; ///< grey level of the letters

std::string without_marks(std::string_view text)
{
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\\' && i + 1 < text.size()) {
            out += text[++i];
            continue;
        }
        if (text[i] == '*' || text[i] == '`') continue;
        out += text[i];
    }
    return out;
}

std::string_view trimmed(std::string_view text)
{
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
        text.remove_suffix(1);
    return text;
}

/// Length of a list mark such as "3. " or "- "; 0 = none.
std::size_t item_mark(std::string_view line)
{
    if (line.size() > 2 && (line[0] == '-' || line[0] == '*' || line[0] == '+') && line[1] == ' ') return 2;
    std::size_t digits = 0;
    while (digits < line.size() && line[digits] >= '0' && line[digits] <= '9') ++digits;
    bool const numbered = digits > 0 && line.substr(digits).starts_with(". ");
    return numbered ? digits + 2 : 0;
}

void begin_window(glm::vec2 corner_px, glm::vec2 size_px, char const* name)
{
    ImGui::SetNextWindowPos({corner_px.x, corner_px.y});
    ImGui::SetNextWindowSize({size_px.x, size_px.y});
    ImGui::PushStyleColor(ImGuiCol_Text, {kDark, kDark, kDark, 1});
    ImGui::Begin(name, nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoBackground |
                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoSavedSettings);
}

void end_window()
{
    ImGui::End();
    ImGui::PopStyleColor();
}

void centred(std::string const& text, float width_px)
{
    float const wide = ImGui::CalcTextSize(text.c_str(), nullptr, false, width_px).x;
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0f, 0.5f * (width_px - wide)));
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width_px);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
}

} // namespace

std::vector<PageLine> parse_page(std::string_view markdown)
{
    using Kind = PageLine::Kind;
    std::vector<PageLine> lines;
    auto const gap = [&] {
        if (!lines.empty() && lines.back().kind != Kind::gap) lines.push_back({Kind::gap, ""});
    };
    while (!markdown.empty()) {
        auto const end = std::min(markdown.find('\n'), markdown.size());
        std::string_view const line = trimmed(markdown.substr(0, end));
        markdown.remove_prefix(std::min(end + 1, markdown.size()));
        if (line.empty()) {
            gap();
        } else if (line.front() == '#') {
            gap();
            lines.push_back(
                {Kind::heading,
                 without_marks(trimmed(line.substr(std::min(line.find_first_not_of('#'), line.size()))))});
            gap();
        } else if (std::size_t const mark = item_mark(line); mark > 0) {
            std::string const sign =
                line[0] >= '0' && line[0] <= '9' ? std::string(line.substr(0, mark)) : "\xE2\x80\xA2 ";
            lines.push_back({Kind::item, sign + without_marks(trimmed(line.substr(mark)))});
        } else if (!lines.empty() && (lines.back().kind == Kind::text || lines.back().kind == Kind::item)) {
            lines.back().text += ' ' + without_marks(line); // a line break does not end a paragraph
        } else {
            lines.push_back({Kind::text, without_marks(line)});
        }
    }
    while (!lines.empty() && lines.back().kind == Kind::gap) lines.pop_back();
    return lines;
}

void draw_page(glm::vec2 size_px, std::vector<PageLine> const& lines, std::string const& footer,
               std::function<void()> const& more)
{
    // Lines of about 70 characters are the most readable.
    float const width = std::min(0.9f * size_px.x, 36 * ImGui::GetFontSize());
    begin_window({0.5f * (size_px.x - width), 0.06f * size_px.y}, {width, 0.9f * size_px.y}, "page");
    ImGui::PushTextWrapPos(width - ImGui::GetStyle().WindowPadding.x);
    for (PageLine const& line : lines) {
        switch (line.kind) {
        case PageLine::Kind::gap:
            ImGui::Dummy({0, 0.5f * ImGui::GetFontSize()});
            break;
        case PageLine::Kind::heading:
            ImGui::SetWindowFontScale(1.3f);
            ImGui::TextUnformatted(line.text.c_str());
            ImGui::SetWindowFontScale(1);
            break;
        case PageLine::Kind::item:
            ImGui::Indent();
            ImGui::TextUnformatted(line.text.c_str());
            ImGui::Unindent();
            break;
        case PageLine::Kind::text:
            ImGui::TextUnformatted(line.text.c_str());
        }
    }
    ImGui::PopTextWrapPos();
    if (more) {
        ImGui::Dummy({0, ImGui::GetFontSize()});
        more();
    }
    end_window();
    draw_prompt(size_px, footer);
}

void draw_prompt(glm::vec2 size_px, std::string const& text)
{
    if (text.empty()) return;
    float const width = 0.94f * size_px.x, line = 1.4f * ImGui::GetFontSize();
    float const tall = ImGui::CalcTextSize(text.c_str(), nullptr, false, width).y + line;
    begin_window({0.03f * size_px.x, size_px.y - tall}, {width, tall}, "prompt");
    centred(text, width - 2 * ImGui::GetStyle().WindowPadding.x);
    end_window();
}

void draw_cross(glm::vec2 size_px)
{
    float const reach = 0.6f * ImGui::GetFontSize();
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    ImU32 const dark = ImGui::GetColorU32({kDark, kDark, kDark, 1});
    ImVec2 const c{std::floor(0.5f * size_px.x) + 0.5f, std::floor(0.5f * size_px.y) + 0.5f};
    list.AddLine({c.x - reach, c.y}, {c.x + reach, c.y}, dark, 2);
    list.AddLine({c.x, c.y - reach}, {c.x, c.y + reach}, dark, 2);
}

int draw_scale(float width_px, std::vector<std::string> const& steps, std::string const& low_label,
               std::string const& high_label, int chosen)
{
    int clicked = -1;
    float const gap = 6, count = float(std::max<std::size_t>(1, steps.size()));
    ImVec2 const box{std::min(4 * ImGui::GetFontSize(), (width_px - gap * (count - 1)) / count),
                     2 * ImGui::GetFontSize()};
    float const left = ImGui::GetCursorPosX() + 0.5f * (width_px - (box.x * count + gap * (count - 1)));
    for (std::size_t i = 0; i < steps.size(); ++i) {
        bool const is_chosen = int(i) == chosen;
        if (i > 0) ImGui::SameLine();
        ImGui::SetCursorPosX(left + float(i) * (box.x + gap));
        float const grey = is_chosen ? 0.9f : 0.62f;
        ImGui::PushStyleColor(ImGuiCol_Button, {grey, grey, grey, 1});
        ImGui::PushStyleColor(ImGuiCol_ButtonHovered, {0.75f, 0.75f, 0.75f, 1});
        ImGui::PushStyleColor(ImGuiCol_ButtonActive, {0.9f, 0.9f, 0.9f, 1});
        if (ImGui::Button((steps[i] + "##" + std::to_string(i)).c_str(), box)) clicked = int(i);
        ImGui::PopStyleColor(3);
    }
    ImGui::SetCursorPosX(left);
    ImGui::TextUnformatted(low_label.c_str());
    float const wide = ImGui::CalcTextSize(high_label.c_str()).x;
    ImGui::SameLine();
    ImGui::SetCursorPosX(std::max(left, left + box.x * count + gap * (count - 1) - wide));
    ImGui::TextUnformatted(high_label.c_str());
    return clicked;
}

} // namespace viewer
