#include "viewer/devices/gl/panel.h"

#include <algorithm>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <cmath>
#include <epoxy/gl.h>
#include <filesystem>
#include <imgui.h>

namespace viewer {

namespace {

/// Font that is readable from a distance: an outline font if one is installed, else the built-in one, enlarged.
void add_font(float px)
{
    constexpr char const* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    // Latin, Greek, Cyrillic; punctuation, currencies, arrows.
    static ImWchar const kLetters[] = {0x20,   0x24f,  0x370,  0x52f,  0x2010, 0x205e,
                                       0x20a0, 0x20bf, 0x2190, 0x2193, 0};
    if (std::filesystem::exists(kFont)) {
        fonts.AddFontFromFileTTF(kFont, px, nullptr, kLetters);
        return;
    }
    ImFontConfig enlarged;
    enlarged.SizePixels = px;
    fonts.AddFontDefault(&enlarged);
}

} // namespace

float panel_font_px(float content_scale) { return std::round(16 * std::clamp(content_scale, 0.5f, 4.0f)); }

Panel::Panel(Window& window, float font_px, PanelInput input) : window_(window)
{
    IMGUI_CHECKVERSION();
    context_ = ImGui::CreateContext();
    ImGui::SetCurrentContext(context_);
    ImGui::GetIO().IniFilename = nullptr; // write no settings file
    ImGui::StyleColorsDark();
    if (font_px > 0) add_font(font_px);
    ImGui_ImplGlfw_InitForOpenGL(window.glfw(), input == PanelInput::taken);
    ImGui_ImplOpenGL3_Init("#version 450 core");
    ImGui_ImplOpenGL3_NewFrame(); // creates its textures and programs
}

Panel::~Panel()
{
    window_.gl().make_current();
    ImGui::SetCurrentContext(context_);
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext(context_);
}

void Panel::begin()
{
    ImGui::SetCurrentContext(context_);
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Panel::finish() { ImGui::Render(); }

void Panel::draw()
{
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    ImGui::SetCurrentContext(context_);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Panel::claim(std::vector<InputEvent>& events) const
{
    ImGui::SetCurrentContext(context_);
    ImGuiIO const& io = ImGui::GetIO();
    for (InputEvent& e : events) {
        bool const keys = e.kind == InputKind::key || e.kind == InputKind::character;
        bool const mouse =
            e.kind == InputKind::mouse_move || e.kind == InputKind::mouse_button || e.kind == InputKind::scroll;
        if (e.action == InputAction::release) continue;
        if ((keys && io.WantCaptureKeyboard) || (mouse && io.WantCaptureMouse)) e.meant_for = InputFor::panel;
    }
}

void add_panel_font(float px) { add_font(px); }

} // namespace viewer
