#include "Progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <sstream>

#include "StandardOutput.h"

namespace {

constexpr double kBetweenBars = 0.1, kBetweenLines = 5;  // s
/** Before, nobody waits, and the time that is left is a guess; s. */
constexpr double kWorthTelling = 2;
constexpr int kBarWidth = 30;

double seconds(std::chrono::steady_clock::duration d) {
  return std::chrono::duration<double>(d).count();
}

/** ", 1:05 left" */
std::string timeLeft(double secondsPassed, double share) {
  if (secondsPassed < kWorthTelling || share <= 0) return {};
  const long left = std::lround(secondsPassed * (1 - share) / share);
  std::ostringstream text;
  text << ", " << left / 60 << ':' << std::setw(2) << std::setfill('0') << left % 60 << " left";
  return text.str();
}

/** "[####....] 50 %, " */
std::string shareText(double share, bool withBar) {
  const int full = static_cast<int>(share * kBarWidth);
  const std::string bar = "[" + std::string(full, '#') + std::string(kBarWidth - full, '.') + "] ";
  return (withBar ? bar : "") + std::to_string(static_cast<int>(100 * share)) + " %, ";
}

}  // namespace

Progress::Progress(std::string task, std::uint64_t total)
    : m_task(std::move(task)),
      m_total(total),
      m_onTerminal(isatty(STDOUT_FILENO)),
      m_said(m_onTerminal ? Clock::time_point() : m_began) {}

Progress::~Progress() {
  if (m_isDrawn) replaceLine();
}

void Progress::update(std::uint64_t done, const std::string& note) {
  const Clock::time_point now = Clock::now();
  if (seconds(now - m_said) < (m_onTerminal ? kBetweenBars : kBetweenLines)) return;
  m_said = now;
  if (m_onTerminal) replaceLine();
  notes() << m_task << ": ";
  const double share =
      m_total == 0 ? 0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(m_total));
  if (m_total > 0) notes() << shareText(share, m_onTerminal);
  notes() << note << timeLeft(seconds(now - m_began), share);
  if (m_onTerminal)
    notes() << std::flush;
  else
    notes() << std::endl;
  m_isDrawn = m_onTerminal;
}
