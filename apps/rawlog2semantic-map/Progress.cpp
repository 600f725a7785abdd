#include "Progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ostream>

#include "StandardOutput.h"

namespace rawlog2semantic_map {

namespace {

constexpr double kBetweenBars = 100, kBetweenLines = 5000;  // ms
constexpr int kBarWidth = 30;

}  // namespace

Progress::Progress(std::string task, std::uint64_t total)
    : m_task(std::move(task)),
      m_total(std::max<std::uint64_t>(total, 1)),
      m_onTerminal(isatty(STDOUT_FILENO)) {}

void Progress::update(std::uint64_t done, const std::string& note) {
  if (m_sinceSaid.milliseconds() < (m_onTerminal ? kBetweenBars : kBetweenLines)) return;
  m_sinceSaid.lap();
  const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(m_total));
  if (m_onTerminal)
    drawBar(share, note);
  else
    notes() << m_task << ": " << static_cast<int>(100 * share) << " %, " << note << std::endl;
}

void Progress::drawBar(double share, const std::string& note) {
  const int full = static_cast<int>(share * kBarWidth);
  replaceLine();
  notes() << m_task << " [" << std::string(full, '#') << std::string(kBarWidth - full, '.') << "] "
          << static_cast<int>(100 * share) << " % " << note << std::flush;
}

void Progress::finish(const std::string& note) {
  replaceLine();
  notes() << m_task << ": " << note << std::endl;
}

}  // namespace rawlog2semantic_map
