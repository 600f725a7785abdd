#include "Progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>

namespace rawlog2semantic_map {

using Clock = std::chrono::steady_clock;

namespace {

constexpr auto kBetweenBars = std::chrono::milliseconds(100);
constexpr auto kBetweenLines = std::chrono::seconds(5);
constexpr int kBarWidth = 30;
const char* const kClearLine = "\r\033[K";

}  // namespace

Progress::Progress(std::string task, std::uint64_t total)
    : m_task(std::move(task)),
      m_total(std::max<std::uint64_t>(total, 1)),
      m_onTerminal(isatty(STDOUT_FILENO)),
      m_lastSaid(Clock::now()) {}

void Progress::update(std::uint64_t done, const std::string& note) {
  const auto now = Clock::now();
  if (now - m_lastSaid < (m_onTerminal ? Clock::duration(kBetweenBars) : kBetweenLines)) return;
  m_lastSaid = now;
  const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(m_total));
  if (m_onTerminal)
    drawBar(share, note);
  else
    std::cout << m_task << ": " << static_cast<int>(100 * share) << " %, " << note << std::endl;
}

void Progress::drawBar(double share, const std::string& note) {
  const int full = static_cast<int>(share * kBarWidth);
  std::cout << kClearLine << m_task << " [" << std::string(full, '#')
            << std::string(kBarWidth - full, '.') << "] " << static_cast<int>(100 * share) << " % "
            << note << std::flush;
}

void Progress::finish(const std::string& note) {
  std::cout << (m_onTerminal ? kClearLine : "") << m_task << ": " << note << std::endl;
}

}  // namespace rawlog2semantic_map
