#include "tests/viewer_show/x/x_window.h"

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <cstdlib>
#include <dlfcn.h>
#include <stdexcept>
#include <thread>

namespace viewer::test {
namespace {

/// The window may go at any time; what is then asked fails, which its caller sees by the result.
int ignore(Display*, XErrorEvent*) { return 0; }

/// The library without its headers is what a machine with xdotool has.
struct FakeInput {
    int (*key)(Display*, unsigned code, int down, unsigned long delay_ms) = nullptr;
    int (*button)(Display*, unsigned number, int down, unsigned long delay_ms) = nullptr;
    int (*motion)(Display*, int screen, int x, int y, unsigned long delay_ms) = nullptr;

    FakeInput()
    {
        void* const library = dlopen("libXtst.so.6", RTLD_NOW);
        if (library == nullptr) return;
        key = reinterpret_cast<decltype(key)>(dlsym(library, "XTestFakeKeyEvent"));
        button = reinterpret_cast<decltype(button)>(dlsym(library, "XTestFakeButtonEvent"));
        motion = reinterpret_cast<decltype(motion)>(dlsym(library, "XTestFakeMotionEvent"));
    }
    bool works() const { return key != nullptr && button != nullptr && motion != nullptr; }
};

Window find(Display* display, std::string const& title)
{
    Window root = 0, parent = 0, *children = nullptr;
    unsigned count = 0;
    if (XQueryTree(display, DefaultRootWindow(display), &root, &parent, &children, &count) == 0) return 0;
    Window found = 0;
    for (unsigned i = 0; i < count && found == 0; ++i) {
        char* name = nullptr;
        XWindowAttributes about{};
        if (XFetchName(display, children[i], &name) != 0 && name != nullptr) {
            bool const same = std::string(name).starts_with(title);
            XFree(name);
            if (same && XGetWindowAttributes(display, children[i], &about) != 0 && about.map_state == IsViewable)
                found = children[i];
        }
    }
    if (children != nullptr) XFree(children);
    return found;
}

} // namespace

struct XWindow::State {
    Display* display = nullptr;
    Window window = 0;
    FakeInput fake;
    std::string key_problem;

    ~State()
    {
        if (display != nullptr) XCloseDisplay(display);
    }
    void need_fake() const
    {
        if (!fake.works()) throw std::runtime_error("there is no input by XTEST: " + key_problem);
    }
    void key(std::string const& name, int down) const
    {
        need_fake();
        unsigned const code = XKeysymToKeycode(display, XStringToKeysym(name.c_str()));
        if (code == 0) throw std::runtime_error("there is no key " + name);
        fake.key(display, code, down, CurrentTime);
        XFlush(display);
    }
    void button(int number, int down) const
    {
        need_fake();
        fake.button(display, unsigned(number), down, CurrentTime);
        XFlush(display);
    }
};

XWindow::XWindow(std::string const& title, std::chrono::seconds limit) : state_(std::make_unique<State>())
{
    XSetErrorHandler(ignore);
    State& s = *state_;
    s.display = XOpenDisplay(nullptr);
    if (s.display == nullptr) throw std::runtime_error("no X server");
    auto const end = std::chrono::steady_clock::now() + limit;
    while ((s.window = find(s.display, title)) == 0) {
        if (std::chrono::steady_clock::now() > end) throw std::runtime_error("no window '" + title + "'");
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    if (!s.fake.works()) s.key_problem = "there is no libXtst.so.6";
}

XWindow::~XWindow() = default;

glm::ivec2 XWindow::size_px() const
{
    XWindowAttributes about{};
    XGetWindowAttributes(state_->display, state_->window, &about);
    return {about.width, about.height};
}

glm::ivec2 XWindow::position_px() const
{
    glm::ivec2 at{};
    Window child = 0;
    XTranslateCoordinates(state_->display, state_->window, DefaultRootWindow(state_->display), 0, 0, &at.x, &at.y,
                          &child);
    return at;
}

std::vector<unsigned char> XWindow::picture() const { return picture({0, 0}, size_px()); }

std::vector<unsigned char> XWindow::picture(glm::ivec2 corner, glm::ivec2 size) const
{
    XImage* const image = XGetImage(state_->display, state_->window, corner.x, corner.y, unsigned(size.x),
                                    unsigned(size.y), AllPlanes, ZPixmap);
    if (image == nullptr) return {};
    std::vector<unsigned char> bytes;
    bytes.reserve(3 * std::size_t(size.x) * std::size_t(size.y));
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            unsigned long const pixel = XGetPixel(image, x, y); // of a TrueColor screen of 24 bits
            for (int const shift : {16, 8, 0}) bytes.push_back((unsigned char)(pixel >> shift & 255));
        }
    XDestroyImage(image);
    return bytes;
}

void XWindow::move(glm::ivec2 to)
{
    XMoveWindow(state_->display, state_->window, to.x, to.y);
    XSync(state_->display, False);
}

void XWindow::resize(glm::ivec2 size)
{
    XResizeWindow(state_->display, state_->window, unsigned(size.x), unsigned(size.y));
    XSync(state_->display, False);
}

void XWindow::ask_to_close()
{
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = state_->window;
    event.xclient.message_type = XInternAtom(state_->display, "WM_PROTOCOLS", False);
    event.xclient.format = 32;
    event.xclient.data.l[0] = long(XInternAtom(state_->display, "WM_DELETE_WINDOW", False));
    event.xclient.data.l[1] = CurrentTime;
    XSendEvent(state_->display, state_->window, False, NoEventMask, &event);
    XSync(state_->display, False);
}

void XWindow::focus()
{
    XSetInputFocus(state_->display, state_->window, RevertToPointerRoot, CurrentTime);
    XSync(state_->display, False);
}

void XWindow::press(std::string const& key) { state_->key(key, 1); }
void XWindow::release(std::string const& key) { state_->key(key, 0); }
void XWindow::tap(std::string const& key)
{
    press(key);
    release(key);
}
void XWindow::point_at(glm::ivec2 px)
{
    state_->need_fake();
    glm::ivec2 const on_screen = position_px() + px;
    state_->fake.motion(state_->display, -1, on_screen.x, on_screen.y, CurrentTime);
    XFlush(state_->display);
}
void XWindow::press_button(int number) { state_->button(number, 1); }
void XWindow::release_button(int number) { state_->button(number, 0); }
std::string const& XWindow::key_problem() const { return state_->key_problem; }

} // namespace viewer::test
