#include "LiveMap.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <semantic_octree/TreeFile.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <thread>

extern char** environ;

using namespace std::chrono_literals;

/** Their ports lie below those that the system gives away. A name in the abstract name space of
 * sockets is taken for as long as the socket is open. */
DomainOfItsOwn::DomainOfItsOwn() : m_lock(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  for (int round = 0; round < 6000; ++round) {
    const int domain = 10 + round % 80;
    sockaddr_un address{AF_UNIX, {}};
    const int length = std::snprintf(address.sun_path + 1, 40, "mso_dds_domain_%d", domain);
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + length);
    if (bind(m_lock, reinterpret_cast<const sockaddr*>(&address), size) == 0) {
      setenv("ROS_DOMAIN_ID", std::to_string(domain).c_str(), 1);
      setenv("ROS_LOCALHOST_ONLY", "1", 1);
      unsetenv("CYCLONEDDS_URI");
      return;
    }
    std::this_thread::sleep_for(10ms);
  }
  throw std::runtime_error("all DDS domains are taken");
}

DomainOfItsOwn::~DomainOfItsOwn() { close(m_lock); }

LiveMap::LiveMap(const std::vector<std::string>& parameters,
                 const std::vector<std::string>& arguments, const LiveMap* beside) {
  if (!beside) m_domain.emplace();
  std::vector<std::string> words = {MSO_BIN_DIR "/semantic-map-ros2", "-v", "-o",
                                    (folder / "map.semantic").string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  words.push_back("--ros-args");
  words.insert(words.end(), parameters.begin(), parameters.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, (folder / "said").c_str(),
                                   O_CREAT | O_WRONLY | O_APPEND, 0666);
  posix_spawn_file_actions_adddup2(&actions, 1, 2);
  if (posix_spawn(&m_process, argv[0], &actions, nullptr, argv.data(), environ) != 0)
    throw std::runtime_error("semantic-map-ros2 cannot be run");
  posix_spawn_file_actions_destroy(&actions);
  m_node = std::make_unique<ros2::Node>("test", ros2::Arguments());
  m_transforms = std::make_unique<ros2::Publication<ros2::TFMessage>>(*m_node, "/tf",
                                                                      ros2::Qos{true, false, 100});
  m_static = std::make_unique<ros2::Publication<ros2::TFMessage>>(*m_node, "/tf_static",
                                                                  ros2::Qos{true, true, 1});
  waitFor([this] { return contains(said(), "Waiting for ") || !isRunning(); });
}

LiveMap::~LiveMap() {
  if (m_process < 0) return;
  kill(m_process, SIGKILL);
  waitpid(m_process, nullptr, 0);
}

bool LiveMap::isRunning() const {
  siginfo_t info{};
  return waitid(P_PID, static_cast<id_t>(m_process), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == 0;
}

bool LiveMap::waitFor(const std::function<bool()>& condition) const {
  const auto until = std::chrono::steady_clock::now() + 120s;
  while (std::chrono::steady_clock::now() < until) {
    if (condition()) return true;
    std::this_thread::sleep_for(5ms);
  }
  ADD_FAILURE() << "it did not come; the program said:\n" << said();
  return false;
}

bool LiveMap::waitForScans(std::size_t scans) const {
  return waitFor([&] {
    const std::string text = said();
    std::size_t found = 0;
    for (std::size_t at = text.find("points inserted"); at != std::string::npos;
         at = text.find("points inserted", at + 1))
      ++found;
    return found >= scans;
  });
}

int LiveMap::end() {
  kill(m_process, SIGINT);
  int status = -1;
  waitpid(m_process, &status, 0);
  m_process = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

semantic_octree::SemanticOcTree LiveMap::map() const {
  return semantic_octree::loadTree((folder / "map.semantic").string());
}

void LiveMap::place(const std::string& parent, const std::string& child, const Eigen::Isometry3d& T,
                    ros2::Stamp stamp, bool isStatic) {
  const auto keep = [this](const std::string& text) -> const std::string& {
    m_frames.push_back(std::make_unique<std::string>(text));
    return *m_frames.back();
  };
  const Eigen::Quaterniond q(T.linear());
  const auto& t = T.translation();
  const ros2::TransformStamped transform = {ros2::headerOf(stamp, keep(parent)),
                                            ros2::textOf(keep(child)),
                                            {{t.x(), t.y(), t.z()}, {q.x(), q.y(), q.z(), q.w()}}};
  std::vector<ros2::TransformStamped> transforms = {transform};
  if (isStatic) {
    m_staticTransforms.push_back(transform);
    transforms = m_staticTransforms;
  }
  ros2::TFMessage message{};
  ros2::refer(message.transforms, transforms);
  send(isStatic ? *m_static : *m_transforms, message);
}

PointMessage::PointMessage(const semantic_types::LabeledCloud& cloud, const std::string& frame,
                           ros2::Stamp stamp, const std::string& classField)
    : m_frame(frame), m_names{"x", "y", "z", classField} {
  constexpr std::uint32_t kStep = 13;
  for (std::uint32_t i = 0; i < 4; ++i)
    m_fields.push_back({ros2::textOf(m_names[i]), 4 * i, std::uint8_t(i < 3 ? 7 : 2), 1});
  m_data.resize(kStep * cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::memcpy(&m_data[kStep * i], cloud.points[i].data(), 12);
    m_data[kStep * i + 12] = cloud.classes.empty() ? 0 : cloud.classes[i];
  }
  m_message.header = ros2::headerOf(stamp, m_frame);
  m_message.height = 1, m_message.width = static_cast<std::uint32_t>(cloud.size());
  ros2::refer(m_message.fields, m_fields);
  m_message.point_step = kStep, m_message.row_step = kStep * m_message.width;
  ros2::refer(m_message.data, m_data);
}
