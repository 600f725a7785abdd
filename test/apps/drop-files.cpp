// drop-files WINDOW FILE...: drops files onto an X window, as a file manager does (XDND, version
// 5). drop-files WINDOW: closes it, as a window manager does.
#include <X11/Xatom.h>
#include <X11/Xlib.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <string>

namespace {

class Drop {
 public:
  Drop(Window target, std::string list) : m_target(target), m_list(std::move(list)) {
    XSetSelectionOwner(m_display, atom("XdndSelection"), m_source, CurrentTime);
  }
  ~Drop() { XCloseDisplay(m_display); }

  void enter() { send("XdndEnter", 5L << 24, long(atom("text/uri-list"))); }
  void move(long x, long y) {
    send("XdndPosition", 0, x << 16 | y, CurrentTime, long(atom("XdndActionCopy")));
  }
  void letGo() { send("XdndDrop", 0, CurrentTime); }
  void close() { send("WM_PROTOCOLS", 0, 0, 0, 0, atom("WM_DELETE_WINDOW")); }

  /** Gives the list when it is asked for, until the window has answered. */
  void await(const char* answer) {
    for (XEvent event;;) {
      XNextEvent(m_display, &event);
      if (event.type == SelectionRequest) give(event.xselectionrequest);
      if (event.type == ClientMessage && event.xclient.message_type == atom(answer)) return;
    }
  }

 private:
  Atom atom(const char* name) const { return XInternAtom(m_display, name, False); }

  void send(const char* type, long l1, long l2 = 0, long l3 = 0, long l4 = 0,
            std::optional<Atom> first = {}) {
    XEvent event = {};
    event.xclient.type = ClientMessage;
    event.xclient.window = m_target;
    event.xclient.message_type = atom(type);
    event.xclient.format = 32;
    const long data[] = {long(first.value_or(m_source)), l1, l2, l3, l4};
    std::copy(data, data + 5, event.xclient.data.l);
    XSendEvent(m_display, m_target, False, NoEventMask, &event);
    XFlush(m_display);
  }

  void give(const XSelectionRequestEvent& request) {
    XChangeProperty(m_display, request.requestor, request.property, request.target, 8,
                    PropModeReplace, reinterpret_cast<const unsigned char*>(m_list.data()),
                    int(m_list.size()));
    XEvent event = {};
    event.xselection.type = SelectionNotify;
    event.xselection.requestor = request.requestor;
    event.xselection.selection = request.selection;
    event.xselection.target = request.target;
    event.xselection.property = request.property;
    XSendEvent(m_display, request.requestor, False, NoEventMask, &event);
    XFlush(m_display);
  }

  Display* m_display = XOpenDisplay(nullptr);
  Window m_source =
             XCreateSimpleWindow(m_display, DefaultRootWindow(m_display), 0, 0, 1, 1, 0, 0, 0),
         m_target;
  std::string m_list;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "drop-files WINDOW [FILE...]\n";
    return 64;
  }
  std::string list;
  for (int i = 2; i < argc; ++i) list += "file://" + std::string(argv[i]) + "\r\n";
  Drop drop(std::strtoul(argv[1], nullptr, 0), list);
  if (argc == 2) {
    drop.close();
    return 0;
  }
  drop.enter();
  drop.move(400, 300);
  drop.await("XdndStatus");
  drop.letGo();
  drop.await("XdndFinished");
}
