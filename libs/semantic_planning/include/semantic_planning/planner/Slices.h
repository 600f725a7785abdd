#pragma once
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace semantic_planning {

/** A call that is done a part at a time: on a thread of its own, which waits whenever a part is
 * done. Nobody works at the same time as it does. Work is counted, not timed, so that the same
 * calls end in the same part on any machine. */
class Slices {
 public:
  explicit Slices(std::function<void()> call);
  /** Leaves the rest of the call undone. */
  ~Slices();
  Slices(const Slices&) = delete;
  Slices& operator=(const Slices&) = delete;

  /** Goes on with the call. \param work how much; what is left of it at the call's end stays
   * \return whether the call has ended. \throw what the call throws */
  bool goOn(std::size_t& work);

  /** Says that so much was done: 1 for a column that a search goes on from, others in the time that
   * this takes. Where the part is at its end it waits for the next one. Without slices: nothing. */
  static void count(std::size_t work);

 private:
  struct Abandoned {};

  void run();
  void handOver(bool toCall);
  void waitFor(bool isCall);

  const std::function<void()> m_call;
  std::mutex m_mutex;
  std::condition_variable m_turn;
  bool m_isTurnOfCall = false, m_ended = false, m_abandoned = false;
  std::size_t m_left = 0;
  std::exception_ptr m_error;
  std::thread m_thread;
};

}  // namespace semantic_planning
