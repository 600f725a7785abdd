#include "LiveMap.h"

#include <nanogui/opengl.h>
#include <strict_files/Words.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "ShowPanel.h"
#include "Widgets.h"

namespace map_window {

using map_view::KeyBox;

namespace {

constexpr int kWidth = 1280, kHeight = 720, kPanel = 230, kMostLines = 4, kPictureWidth = 360;
constexpr double kAttend = 0.005;  // s between looks at what hands do
/** Between counts of a map's leaves, at first; as the map grows they take longer, s. */
constexpr double kCountEvery = 1;
/** The slider's steps a second; at its right end there are as many as can be. */
constexpr float kFastest = 30;

std::vector<std::unique_ptr<Layer>> layersOf(const semantic_octree::SemanticOcTree& map) {
  std::vector<std::unique_ptr<Layer>> layers;
  layers.push_back(std::make_unique<Layer>("map", map));
  return layers;
}

}  // namespace

/** Pause, step and speed, and how far it is. */
class PacePanel {
 public:
  explicit PacePanel(ViewWindow& window) : m_window(window) {
    auto* panel = window.addPanel(ViewWindow::Side::Left, "Live", kPanel)->content();
    auto* row = addRow(panel);
    m_pause = row->add<nanogui::CheckBox>("pause");
    m_pause->setFixedSize({90, 20});
    addButton(row, "step", 60, [this] {
      pause();
      m_steps = true;
    });
    row = addRow(panel);
    addText(row, "speed", 50);
    addSlider(row, 160, 0.5f, kFastest, kFastest, [this](float speed) { m_speed = speed; });
    for (auto& line : m_lines) line = addText(panel, "", kPanel);
  }

  void say(const std::vector<std::string>& lines) {
    for (std::size_t i = 0; i < m_lines.size(); ++i)
      m_lines[i]->setCaption(i < lines.size() ? lines[i] : "");
    m_window.redraw();
  }
  void pause() { m_pause->setChecked(true); }
  /** Whether the next step is due so many seconds after the last one. */
  bool isDue(double seconds) {
    if (m_pause->checked()) return std::exchange(m_steps, false);
    return m_speed >= kFastest || seconds >= 1 / double(m_speed);
  }

 private:
  ViewWindow& m_window;
  nanogui::CheckBox* m_pause;
  std::array<nanogui::Label*, kMostLines> m_lines{};
  bool m_steps = false;
  float m_speed = kFastest;
};

class LiveWindow : public LiveMap {
 public:
  LiveWindow(const std::string& title, const semantic_octree::SemanticOcTree& map,
             const Beginning& beginning)
      : m_window(ViewWindow::open(title, kWidth, kHeight)),
        m_viewer(*m_window, layersOf(map), beginning),
        m_pace(*m_window),
        m_show(m_viewer),
        m_ask(m_viewer) {
    m_window->onClick([this](const map_view::Ray& ray) { m_ask.ask(ray); });
    m_window->marks()->insert(m_marks);
    m_window->setVisible(true);
    m_isOpen = m_window->attend();
    if (!beginning.camera) m_camera = m_window->orbitCamera().text();
  }

  mrpt_compat::drawing::CSetOfObjects& marks() override { return *m_marks; }
  void stopWhen(const std::function<bool()>& isToEnd) override { m_isToEnd = isToEnd; }
  bool isOpen() const override { return m_isOpen; }
  void pause() override { m_pace.pause(); }
  void say(const std::vector<std::string>& lines) override {
    if (m_isOpen) m_pace.say(lines);
  }

  void showPicture(const mrpt::img::CImage& picture) override {
    if (m_isOpen) m_window->showPicture(picture, kPictureWidth);
  }
  void changed(const Eigen::AlignedBox3d& box) override { m_changed.extend(box); }

  void show(double seconds) override {
    if (!m_isOpen) return;
    // While tiles are still drawn, others wait: else tiles far away would never have their turn.
    if (!m_changed.isEmpty() && m_isComplete) {
      m_viewer.tiles().touch({keysOf(m_changed)});
      m_changed.setEmpty();
      count();
    }
    const double begin = glfwGetTime();
    m_window->redraw();
    do {
      m_isOpen = m_window->attend();
      if (!m_isOpen) return m_window->setVisible(false);
      m_isComplete = m_window->isComplete();
      const double passed = glfwGetTime() - begin;
      if ((passed >= seconds && m_pace.isDue(passed)) || m_isToEnd()) return;
      if (m_isComplete) glfwWaitEventsTimeout(kAttend);
    } while (true);
  }

  void stay() override {
    m_pace.say({"done: close the window to end"});
    while (m_isOpen && !m_changed.isEmpty() && !m_isToEnd()) show(0);
    if (m_isOpen && !m_isToEnd()) show(HUGE_VAL);
  }

 private:
  KeyBox keysOf(const Eigen::AlignedBox3d& box) {
    const auto keys = [this](const Eigen::Vector3d& place) {
      return (place.array() / m_viewer.layer().map().getResolution() +
              semantic_octree::kKeyOfOrigin)
          .floor()
          .max(0)
          .min(semantic_octree::kNumKeys - 1)
          .cast<int>()
          .eval();
    };
    return {keys(box.min()), keys(box.max())};
  }
  /** Leaves by class, and where the map is. The camera follows as long as nobody has moved it. */
  void count() {
    if (glfwGetTime() < m_countAt) return;
    const double begin = glfwGetTime();
    m_viewer.layer().grown();
    m_show.refresh();
    if (m_window->orbitCamera().text() == m_camera) {
      m_viewer.lookFrom(m_window->orbitCamera().azimuth, m_window->orbitCamera().elevation);
      m_camera = m_window->orbitCamera().text();
    }
    const double now = glfwGetTime();
    m_countAt = now + std::max(kCountEvery, 10 * (now - begin));
  }

  const WindowSystem m_system;
  std::unique_ptr<ViewWindow> m_window;
  Viewer m_viewer;
  PacePanel m_pace;
  ShowPanel m_show;
  AskPanel m_ask;
  bool m_isOpen = true, m_isComplete = true;
  std::function<bool()> m_isToEnd = [] { return false; };
  const mrpt_compat::drawing::CSetOfObjects::Ptr m_marks =
      mrpt_compat::drawing::CSetOfObjects::Create();
  Eigen::AlignedBox3d m_changed;
  std::string m_camera;  ///< as it followed last
  double m_countAt = 0;  ///< s of GLFW's clock
};

std::unique_ptr<LiveMap> LiveMap::open(const std::string& title,
                                       const semantic_octree::SemanticOcTree& map,
                                       const Beginning& beginning) try {
  return std::make_unique<LiveWindow>(title, map, beginning);
} catch (const std::exception& e) {
  throw std::runtime_error("--live: " + strict_files::messageOf(e));
}

}  // namespace map_window
