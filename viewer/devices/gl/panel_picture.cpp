#include "viewer/devices/gl/panel_picture.h"

#include "viewer/devices/gl/panel.h"

#include <algorithm>
#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <limits>

namespace viewer {

PanelPicture::PanelPicture(GlContext const& gl, glm::ivec2 size_px, float font_px)
    : gl_(gl), size_px_(size_px), target_(TextureTarget::Format::bytes, size_px)
{
    IMGUI_CHECKVERSION();
    ImGuiContext* const before = ImGui::GetCurrentContext();
    context_ = ImGui::CreateContext();
    ImGui::SetCurrentContext(context_);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.MouseDrawCursor = true;
    io.DisplaySize = ImVec2(float(size_px.x), float(size_px.y));
    ImGui::StyleColorsDark();
    ImGui::GetStyle().ScaleAllSizes(std::max(1.0f, font_px / 13));
    add_panel_font(font_px);
    ImGui_ImplOpenGL3_Init("#version 450 core");
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::SetCurrentContext(before);
}

PanelPicture::~PanelPicture()
{
    gl_.make_current();
    ImGuiContext* const before = ImGui::GetCurrentContext();
    ImGui::SetCurrentContext(context_);
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext(context_);
    ImGui::SetCurrentContext(before == context_ ? nullptr : before);
}

void PanelPicture::begin(std::optional<glm::dvec2> pointer_px, bool pressed, double scroll, double seconds)
{
    ImGui::SetCurrentContext(context_);
    ImGuiIO& io = ImGui::GetIO();
    float const nowhere = -std::numeric_limits<float>::max();
    io.MousePos = pointer_px ? ImVec2(float(pointer_px->x), float(pointer_px->y)) : ImVec2(nowhere, nowhere);
    io.MouseDown[0] = pointer_px && pressed;
    io.MouseWheel = pointer_px ? float(scroll) : 0;
    io.DeltaTime = std::max(1e-4f, float(seconds));
    ImGui::NewFrame();
    // Windows open where they would on a desktop; here each top one takes the whole picture.
    for (ImGuiWindow* const window : context_->Windows) {
        int const special = ImGuiWindowFlags_ChildWindow | ImGuiWindowFlags_Popup | ImGuiWindowFlags_Tooltip |
                            ImGuiWindowFlags_Modal;
        if ((window->Flags & special) != 0 || window->IsFallbackWindow) continue;
        ImGui::SetWindowPos(window, ImVec2(0, 0), ImGuiCond_Always);
        ImGui::SetWindowSize(window, io.DisplaySize, ImGuiCond_Always);
        ImGui::SetWindowCollapsed(window, false, ImGuiCond_Always);
    }
}

void PanelPicture::finish() { ImGui::Render(); }

std::vector<unsigned char> PanelPicture::draw()
{
    ImGui::SetCurrentContext(context_);
    DrawTarget target = target_.target();
    clear(target);
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    target.rows = RowOrder::top_last; // as ImGui draws
    return read_bytes(target);
}

} // namespace viewer
