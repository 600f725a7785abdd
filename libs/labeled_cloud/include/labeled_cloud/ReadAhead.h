#pragma once
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace labeled_cloud {

/** Makes a sequence of things in a thread of its own, a few ahead of whoever takes them; their
 * order is that in which they were made. */
template <typename T>
class ReadAhead {
 public:
  /** \param make The next thing, or nothing at the end. Called in the thread only.
   * \param capacity How many may wait. */
  ReadAhead(std::function<std::optional<T>()> make, std::size_t capacity)
      : m_make(std::move(make)), m_capacity(capacity), m_thread([this] { run(); }) {}

  ~ReadAhead() {
    {
      const std::lock_guard lock(m_mutex);
      m_stopped = true;
    }
    m_changed.notify_all();
    m_thread.join();
  }
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  /** The next thing, or nothing at the end.
   * \throw whatever MAKE threw, in its place of the sequence. */
  std::optional<T> next() {
    std::unique_lock lock(m_mutex);
    m_changed.wait(lock, [this] { return !m_made.empty() || m_ended; });
    if (m_made.empty()) {
      if (m_error) std::rethrow_exception(std::exchange(m_error, nullptr));
      return std::nullopt;
    }
    std::optional<T> taken = std::move(m_made.front());
    m_made.pop_front();
    lock.unlock();
    m_changed.notify_all();
    return taken;
  }

 private:
  void run() {
    try {
      while (std::optional<T> made = m_make())
        if (!put(std::move(*made))) break;
    } catch (...) {
      m_error = std::current_exception();  // read under the lock, after m_ended
    }
    const std::lock_guard lock(m_mutex);
    m_ended = true;
    m_changed.notify_all();
  }

  /** Whether there is need of more. */
  bool put(T made) {
    std::unique_lock lock(m_mutex);
    m_changed.wait(lock, [this] { return m_made.size() < m_capacity || m_stopped; });
    if (m_stopped) return false;
    m_made.push_back(std::move(made));
    lock.unlock();
    m_changed.notify_all();
    return true;
  }

  std::function<std::optional<T>()> m_make;
  std::size_t m_capacity;
  std::mutex m_mutex;
  std::condition_variable m_changed;
  std::deque<T> m_made;
  std::exception_ptr m_error;
  bool m_ended = false, m_stopped = false;
  std::thread m_thread;  // last: it uses the others
};

}  // namespace labeled_cloud
