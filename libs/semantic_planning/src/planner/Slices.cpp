#include <semantic_planning/planner/Slices.h>

#include <utility>

namespace semantic_planning {

namespace {

thread_local Slices* slicesOfThread = nullptr;

}  // namespace

Slices::Slices(std::function<void()> call) : m_call(std::move(call)), m_thread([this] { run(); }) {}

Slices::~Slices() {
  m_abandoned = true;
  if (!m_ended) handOver(true);
  m_thread.join();
}

void Slices::run() {
  waitFor(true);
  slicesOfThread = this;
  try {
    if (!m_abandoned) m_call();
  } catch (const Abandoned&) {
  } catch (...) {
    m_error = std::current_exception();
  }
  m_ended = true;
  handOver(false);
}

void Slices::handOver(bool toCall) {
  const std::lock_guard<std::mutex> lock(m_mutex);
  m_isTurnOfCall = toCall;
  m_turn.notify_all();
}

void Slices::waitFor(bool isCall) {
  std::unique_lock<std::mutex> lock(m_mutex);
  m_turn.wait(lock, [&] { return m_isTurnOfCall == isCall; });
}

bool Slices::goOn(std::size_t& work) {
  if (m_ended) return true;
  m_left = work;
  handOver(true);
  waitFor(false);
  work = m_left;
  if (m_error) std::rethrow_exception(std::exchange(m_error, nullptr));
  return m_ended;
}

void Slices::count(std::size_t work) {
  Slices* const slices = slicesOfThread;
  if (!slices) return;
  if (slices->m_left > work) {
    slices->m_left -= work;
    return;
  }
  slices->m_left = 0;
  slices->handOver(false);
  slices->waitFor(true);
  if (slices->m_abandoned) throw Abandoned();
}

}  // namespace semantic_planning
