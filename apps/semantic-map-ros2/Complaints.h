#pragma once
#include <map>
#include <mutex>
#include <string>

namespace semantic_map_ros2 {

/** Says what is wrong with messages once for each kind, and at the end how often. Any thread may
 * complain. */
class Complaints {
 public:
  /** \param what comes again and again in the same words, but for numbers \param details of the
   * first time */
  void say(const std::string& what, const std::string& details = {});
  /** How often each was said that was said more than once. */
  void sum() const;

 private:
  struct Said {
    std::string what;  ///< the first time
    std::size_t count;
  };
  mutable std::mutex m_mutex;
  std::map<std::string, Said> m_said;  ///< by kind
};

}  // namespace semantic_map_ros2
