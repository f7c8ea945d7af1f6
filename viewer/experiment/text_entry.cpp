#include "viewer/experiment/text_entry.h"

#include "gi/core/text.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <imgui.h>

namespace viewer {
namespace {

std::string utf8(unsigned unicode)
{
    std::string text;
    auto const put = [&](unsigned byte) { text += char(byte); };
    auto const more = [&](int shift) { put(0x80 | ((unicode >> shift) & 0x3f)); };
    if (unicode < 0x80) {
        put(unicode);
        return text;
    }
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
    return text;
}

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

} // namespace

TextEntry::TextEntry(int lines, int max_chars, std::string text)
    : lines_(lines), max_chars_(max_chars), text_(std::move(text)), cursor_(text_.size())
{
}

bool TextEntry::is_full() const { return gi::characters(text_) >= std::size_t(max_chars_); }

std::size_t TextEntry::before(std::size_t at) const
{
    if (at == 0) return 0;
    do --at;
    while (at > 0 && continues(text_[at]));
    return at;
}

std::size_t TextEntry::after(std::size_t at) const
{
    if (at >= text_.size()) return text_.size();
    do ++at;
    while (at < text_.size() && continues(text_[at]));
    return at;
}

std::size_t TextEntry::line_start(std::size_t at) const
{
    auto const end = at == 0 ? std::string::npos : text_.rfind('\n', at - 1);
    return end == std::string::npos ? 0 : end + 1;
}

std::size_t TextEntry::line_end(std::size_t at) const { return std::min(text_.find('\n', at), text_.size()); }

void TextEntry::insert(unsigned unicode)
{
    if (is_full()) return;
    std::string const bytes = utf8(unicode);
    text_.insert(cursor_, bytes);
    cursor_ += bytes.size();
}

/// Keeps the column, as far as the other line reaches.
void TextEntry::move_line(int by)
{
    std::size_t const start = line_start(cursor_), end = line_end(cursor_);
    if (by < 0 ? start == 0 : end == text_.size()) return;
    std::size_t const column = gi::characters(std::string_view(text_).substr(start, cursor_ - start));
    cursor_ = by < 0 ? line_start(start - 1) : end + 1;
    std::size_t const last = line_end(cursor_);
    for (std::size_t i = 0; i < column && cursor_ < last; ++i) cursor_ = after(cursor_);
}

void TextEntry::take(InputEvent const& e)
{
    if (e.kind == InputKind::character && e.code >= 32 && e.code != 127) return insert(unsigned(e.code));
    if (e.kind != InputKind::key || e.action == InputAction::release) return;
    switch (e.code) {
    case GLFW_KEY_LEFT:
        cursor_ = before(cursor_);
        break;
    case GLFW_KEY_RIGHT:
        cursor_ = after(cursor_);
        break;
    case GLFW_KEY_UP:
        move_line(-1);
        break;
    case GLFW_KEY_DOWN:
        move_line(1);
        break;
    case GLFW_KEY_HOME:
        cursor_ = line_start(cursor_);
        break;
    case GLFW_KEY_END:
        cursor_ = line_end(cursor_);
        break;
    case GLFW_KEY_BACKSPACE: {
        std::size_t const from = before(cursor_);
        text_.erase(from, cursor_ - from);
        cursor_ = from;
        break;
    }
    case GLFW_KEY_DELETE:
        text_.erase(cursor_, after(cursor_) - cursor_);
        break;
    case GLFW_KEY_ENTER:
    case GLFW_KEY_KP_ENTER:
        if (lines_ > 1 && (e.modifiers & GLFW_MOD_CONTROL) == 0) insert('\n');
        break;
    }
}

void TextEntry::draw(float width_px) const
{
    float const line_px = ImGui::GetFontSize(), margin_px = 0.4f * line_px, wide_px = width_px - 2 * margin_px;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImFont const& font = *ImGui::GetFont();
    char const* const begin = text_.data();
    // Lines as they are shown, and the cursor's.
    std::vector<std::pair<char const*, char const*>> shown;
    std::size_t cursor_line = 0;
    for (char const* at = begin; true;) {
        char const* const end = begin + line_end(std::size_t(at - begin));
        do {
            char const* cut = font.CalcWordWrapPositionA(1, at, end, wide_px);
            if (cut == at && at < end) cut = begin + after(std::size_t(at - begin));
            // The blank at which a line was broken stays in it: every character is in one line.
            while (cut < end && *cut == ' ') ++cut;
            if (begin + cursor_ >= at) cursor_line = shown.size();
            shown.emplace_back(at, cut);
            at = cut;
        } while (at < end);
        if (end == begin + text_.size()) break;
        at = end + 1;
    }
    std::size_t const high = std::max<std::size_t>(std::size_t(lines_), shown.size());
    ImVec2 const corner = ImGui::GetCursorScreenPos();
    ImVec2 const size{width_px, float(high) * line_px + 2 * margin_px};
    list.AddRectFilled(corner, {corner.x + size.x, corner.y + size.y},
                       ImGui::GetColorU32({0.62f, 0.62f, 0.62f, 1}));
    ImU32 const dark = ImGui::GetColorU32(ImGuiCol_Text);
    for (std::size_t i = 0; i < shown.size(); ++i) {
        ImVec2 const at{corner.x + margin_px, corner.y + margin_px + float(i) * line_px};
        list.AddText(at, dark, shown[i].first, shown[i].second);
        if (i != cursor_line) continue;
        float const x = at.x + ImGui::CalcTextSize(shown[i].first, begin + cursor_).x;
        list.AddLine({x, at.y}, {x, at.y + line_px}, dark, 2);
        // The page follows the cursor.
        ImGui::SetScrollFromPosY(at.y + line_px - ImGui::GetWindowPos().y, 0.8f);
    }
    ImGui::Dummy(size);
}

} // namespace viewer
